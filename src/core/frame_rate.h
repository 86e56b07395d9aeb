// Frames in a second as a fraction of whole numbers, the form of containers, and as the nearest double, the form of
// all times. A fraction and its double name each other.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tumble {

struct FrameRate {
    std::int64_t numerator = 60;   // frames
    std::int64_t denominator = 1;  // s

    double value() const { return double(numerator) / double(denominator); }
    std::string text() const;  // "30000/1001"
    friend bool operator==(const FrameRate&, const FrameRate&) = default;
};

inline constexpr std::int64_t largest_rate_term = 1'000'000;  // ffmpeg reads rates with terms up to 1,001,000

/// The closest fraction with both parts at most a million: 29.97 is 2997/100, and a double next to 30000/1001 is that.
FrameRate to_frame_rate(double fps);

/// "24000/1001": two whole numbers from 1 to a million; nothing for another text.
std::optional<FrameRate> parse_frame_rate(std::string_view text);

/// For readers, and for parsers of rates: "60", "29.97", and "24000/1001" for a double that only many digits tell.
std::string fps_text(double fps);

/// For numbers of frames and steps, products of decimals: 4.35 * 100 is 434.99999999999994. The integer within a few
/// roundings of x, otherwise x. Precondition: x >= 0.
inline double rounded_if_nearly_whole(double x) {
    constexpr double rounding = 1e-12;  // relative; about 4500 units in the last place
    const double nearest = std::nearbyint(x);
    return std::fabs(x - nearest) <= rounding * std::max(1.0, x) ? nearest : x;
}

}  // namespace tumble
