// Words for error messages: numbers, lists of names, guesses at what was meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A number as a message shows it: 16, 0.5, 1e+09, and all the digits that tell it from its neighbors.
std::string number_text(double value);

/// `"plain", "grid", "checker"`.
std::string quoted_list(const std::vector<std::string_view>& names);

/// ` (did you mean "duration"?)` when one of the known names is close to the given one; otherwise, when there are few
/// enough to read, ` (known: ...)`; otherwise nothing.
std::string suggestion(std::string_view given, const std::vector<std::string_view>& known);

}  // namespace tumble
