// Text for error messages: numbers, lists of names, suggestions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// A number for a message: 16, 0.5, 1e+09, with all digits that distinguish it from its neighbors.
std::string number_text(double value);

/// `"plain", "grid", "checker"`.
std::string quoted_list(const std::vector<std::string_view>& names);

/// ` (did you mean "duration"?)` if one of the known names is close to the given one; otherwise empty.
std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& known);

/// The same; without a close one ` (known: ...)` if there are few enough to read.
std::string suggestion(std::string_view given, const std::vector<std::string_view>& known);

}  // namespace tumble
