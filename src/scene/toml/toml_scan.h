// A look at a TOML text before it is parsed: the parser builds its whole tree first, and a small text can ask for a deep or
// a large one.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tumble {

struct TomlAmounts {
    std::size_t keys = 0;    // with all parts of dotted ones: tables among them
    std::size_t items = 0;   // of arrays, and inline tables
};

/// Throws InputError at a key of too many parts, for each is a table within the one before (the parser itself bounds the
/// depth of arrays and inline tables), and RunError where the tree takes more memory than there is.
void check_toml_amounts(std::string_view text, const std::string& file);

/// The same count alone, without errors.
TomlAmounts toml_amounts(std::string_view text);

}  // namespace tumble
