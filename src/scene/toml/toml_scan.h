// Checks a TOML text before it is parsed: the parser builds its whole tree first, and a small text can define a deep or
// a large one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tumble {

struct TomlAmounts {
    std::size_t keys = 0;   // with all parts of dotted ones, including tables
    std::size_t items = 0;  // of arrays, and inline tables
};

/// Throws InputError at a key with too many parts, because each part is a table within the one before (the parser
/// itself limits the depth of arrays and inline tables), and RunError if the tree takes more memory than is available.
void check_toml_amounts(std::string_view text, const std::string& file);

/// The same count without errors.
TomlAmounts toml_amounts(std::string_view text);

}  // namespace tumble
