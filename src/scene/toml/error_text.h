// Text for error messages: the origin of a value, numbers, lists of names, suggestions.
#pragma once

#include "core/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The origin of a value, for errors: a place in the scene file or an option of the command line.
struct SourcePosition {
    std::string name;      // the key ("fps") or the option ("--fps")
    SourceLocation where;  // without a file: an option

    bool is_option() const { return where.file.empty(); }

    /// Throws InputError "FILE:LINE:COLUMN: error: fps PROBLEM", or "error: --fps: PROBLEM" for an option.
    [[noreturn]] void fail(std::string_view problem) const;
};

/// A number for a message: 16, 0.5, 1e+09, with all digits that distinguish it from its neighbors.
std::string number_text(double value);

/// `"plain", "grid", "checker"`.
std::string quoted_list(const std::vector<std::string_view>& names);

/// ` (did you mean "duration"?)` if one of the known names is close to the given one; otherwise empty.
std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& known);

/// The same; without a close one ` (known: ...)` if there are few enough to read.
std::string suggestion(std::string_view given, const std::vector<std::string_view>& known);

}  // namespace tumble
