#include "core/frame_rate.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tumble {
namespace {

constexpr auto readable_digits = 15;  // that every decimal number keeps in a double; more come from a division

/// The continued fraction of x, cut off before a term grows beyond `limit`.
FrameRate best_fraction(double x, std::int64_t limit) {
    std::int64_t n0 = 0, d0 = 1, n1 = 1, d1 = 0;
    double rest = x;
    for (int i = 0; i < 64; ++i) {
        const double whole = std::floor(rest);
        if (whole > double(limit)) break;
        const auto a = static_cast<std::int64_t>(whole);
        const std::int64_t n2 = a * n1 + n0, d2 = a * d1 + d0;
        if (n2 > limit || d2 > limit) break;
        n0 = n1;
        d0 = d1;
        n1 = n2;
        d1 = d2;
        // Digits beyond the rounding of double are meaningless: 29.97 is 2997/100, not a fraction 1e-15 beside it.
        if (std::fabs(double(n1) / double(d1) - x) <= 1e-12 * x) break;
        rest = 1.0 / (rest - whole);
    }
    return {n1, d1};
}

/// The whole text as a term of a fraction, or 0.
std::int64_t term(std::string_view text) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && value >= 1 && value <= largest_rate_term ? value : 0;
}

}  // namespace

std::string FrameRate::text() const { return fmt::format("{}/{}", numerator, denominator); }

FrameRate to_frame_rate(double fps) {
    // Below 1 the first term would be 0; the reciprocal has the same digits.
    if (fps >= 1.0) return best_fraction(fps, largest_rate_term);
    const FrameRate upside_down = best_fraction(1.0 / fps, largest_rate_term);
    return {upside_down.denominator, upside_down.numerator};
}

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return std::nullopt;
    const FrameRate rate{term(text.substr(0, slash)), term(text.substr(slash + 1))};
    if (rate.numerator == 0 || rate.denominator == 0) return std::nullopt;
    return rate;
}

std::string fps_text(double fps) {
    const std::string decimal = fmt::format("{}", fps);
    const auto digits = std::ranges::count_if(decimal, [](char c) { return c >= '0' && c <= '9'; });
    if (digits <= readable_digits) return decimal;
    const FrameRate rate = to_frame_rate(fps);
    return rate.value() == fps ? rate.text() : decimal;
}

}  // namespace tumble
