// Ranges of numbers, sets of names and frame rates, with the error texts for values outside.
#pragma once

#include "core/safe_text.h"
#include "scene/toml/error_text.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The valid values of a number. NaN and infinities are outside of every range.
struct Range {
    double min, max;
    const char* unit = "";      // for messages
    bool min_excluded = false;  // "above min" instead of "at least min"

    bool contains(double value) const {
        return (min_excluded ? value > min : value >= min) && value <= max;  // false for NaN
    }
    /// "must be above 0 and at most 1e+09 m".
    std::string requirement() const;
};

/// The value if it is in the range; otherwise fails at its position.
double checked(double value, const Range& range, const SourcePosition& origin);
std::int64_t checked(std::int64_t value, std::int64_t min, std::int64_t max, const SourcePosition& origin);

/// A name in the file and its value.
template <class Value>
struct Choice {
    std::string_view name;
    Value value;
};

template <class Value>
Value chosen(std::string_view given, std::span<const Choice<Value>> choices, const SourcePosition& origin) {
    std::vector<std::string_view> names;
    for (const auto& choice : choices) {
        if (choice.name == given) return choice.value;
        names.push_back(choice.name);
    }
    origin.fail("must be one of " + quoted_list(names) + " (given \"" + safe_text(given) + "\")" +
                did_you_mean(given, names));
}

/// "60", "29.97" or "24000/1001" to frames per second. Fails at the position for another text and outside of the
/// limits.
double read_frame_rate(std::string_view text, const SourcePosition& origin);

/// The same of a fraction alone: a scene file gives numbers without quotes.
double read_rate_fraction(std::string_view text, const SourcePosition& origin);

}  // namespace tumble
