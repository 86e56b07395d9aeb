// Values by name, in order, as in ("size", "1280x720"). They identify a clip, and messages name those in which two
// clips differ.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tumble {

/// Names are unique.
using NamedValues = std::vector<std::pair<std::string, std::string>>;

/// The value of a name; null if there is none.
inline const std::string* find_value(const NamedValues& values, std::string_view name) {
    const auto found = std::ranges::find(values, name, &NamedValues::value_type::first);
    return found == values.end() ? nullptr : &found->second;
}

}  // namespace tumble
