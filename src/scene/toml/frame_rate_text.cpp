#include "scene/toml/frame_rate_text.h"

#include "core/frame_rate.h"
#include "core/safe_text.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <charconv>

namespace tumble {

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
