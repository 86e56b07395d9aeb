// Images with alpha have two appearances for metrics of colors: on black, and on white.
#pragma once

#include "core/image.h"

#include <cstdint>

namespace tumble {

inline constexpr std::uint8_t black_background = 0, white_background = 255;

/// A channel of a pixel (four bytes) on a background of this level.
inline std::uint8_t seen_on_background(const std::uint8_t* pixel, int channel, int background) {
    const int alpha = pixel[3];
    if (alpha == 255) return pixel[channel];
    return static_cast<std::uint8_t>((2 * (pixel[channel] * alpha + background * (255 - alpha)) + 255) / 510);
}

/// True if a pixel is not opaque.
inline bool has_alpha(const Image& image) {
    for (std::size_t i = 3; i < image.pixels.size(); i += 4)
        if (image.pixels[i] != 255) return true;
    return false;
}

}  // namespace tumble
