// Compositing onto pixels with straight alpha, in encoded values.
#pragma once

#include <cstdint>

namespace tumble {

/// Draws a color (red, green, blue) of an opacity of 0 to 255 over a pixel of four channels, rounded.
inline void put_over(const std::uint8_t* color, std::uint32_t opacity, std::uint8_t* pixel) {
    const std::uint32_t over = 255u * opacity, under = pixel[3] * (255u - opacity), sum = over + under;
    if (sum == 0) return;
    for (int c = 0; c < 3; ++c) pixel[c] = std::uint8_t((color[c] * over + pixel[c] * under + sum / 2) / sum);
    pixel[3] = std::uint8_t((sum + 127u) / 255u);
}

}  // namespace tumble
