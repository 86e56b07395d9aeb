// The windows of rule `window` (compare/image_compare.h), and the difference of two pixels in them.
#pragma once

#include "compare/metrics/background.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace tumble {

inline constexpr int window_side = 8;  // pixels: about the smallest visible object
inline constexpr int window_step =
    window_side / 2;  // windows overlap by half: no small change is split over four of them

/// A channel as a black background shows it.
inline int seen_on_black(const std::uint8_t* pixel, int channel) {
    return seen_on_background(pixel, channel, black_background);
}

/// The largest difference over the four channels of a pixel, levels. The color of a transparent pixel is invisible, and
/// a nearly transparent one has but a few levels of it: colors count as far as alpha shows them.
inline int pixel_difference(const std::uint8_t* a, const std::uint8_t* b) {
    int most = std::abs(int(a[3]) - int(b[3]));
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(seen_on_black(a, c) - seen_on_black(b, c)));
    return most;
}

/// Starts of windows along one side: every step, and one flush with the far edge.
inline std::vector<int> window_starts(int size) {
    std::vector<int> starts;
    for (int i = 0; i + window_side < size; i += window_step) starts.push_back(i);
    starts.push_back(std::max(0, size - window_side));
    return starts;
}

}  // namespace tumble
