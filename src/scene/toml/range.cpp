#include "scene/toml/range.h"

#include <fmt/format.h>

#include <cmath>

namespace tumble {

std::string Range::requirement() const {
    std::string text = "must be ";
    const bool bounded_below = std::isfinite(min), bounded_above = std::isfinite(max);
    if (!bounded_below && !bounded_above) return text + "a finite number";
    if (bounded_below && bounded_above && !min_excluded) {
        text += fmt::format("from {} to {}", number_text(min), number_text(max));
    } else {
        if (bounded_below) text += fmt::format("{} {}", min_excluded ? "above" : "at least", number_text(min));
        if (bounded_below && bounded_above) text += " and ";
        if (bounded_above) text += fmt::format("at most {}", number_text(max));
    }
    if (*unit) text += fmt::format(" {}", unit);
    return text;
}

double checked(double value, const Range& range, const SourcePosition& origin) {
    if (!std::isfinite(value)) origin.fail(fmt::format("must be a finite number (given {})", value));
    if (!range.contains(value)) origin.fail(fmt::format("{} (given {})", range.requirement(), number_text(value)));
    return value;
}

std::int64_t checked(std::int64_t value, std::int64_t min, std::int64_t max, const SourcePosition& origin) {
    if (value < min || value > max) origin.fail(fmt::format("must be from {} to {} (given {})", min, max, value));
    return value;
}

}  // namespace tumble
