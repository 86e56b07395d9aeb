#include "scene/toml/range.h"

#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <charconv>
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

double read_rate_fraction(std::string_view text, const SourcePosition& origin) {
    if (const auto rate = parse_frame_rate(text)) return checked(rate->value(), limits::fps, origin);
    origin.fail(
        fmt::format("must be a number of {}, or a fraction of two whole numbers from 1 to {}, as in \"24000/1001\" "
                    "(given \"{}\")",
                    limits::fps.unit, largest_rate_term, safe_text(text)));
}

double read_frame_rate(std::string_view text, const SourcePosition& origin) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = !text.empty() && error == std::errc() && end == text.data() + text.size();
    return number ? checked(value, limits::fps, origin) : read_rate_fraction(text, origin);
}

}  // namespace tumble
