// Colors as people write them (sRGB bytes) and in linear light.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tumble {

/// An sRGB color, 8 bits per channel.
struct Color {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Color&, const Color&) = default;
};

/// "#rrggbb" (either case) to a color; empty for other text.
std::optional<Color> parse_color(std::string_view text);

/// The "#rrggbb" text of a color.
std::string to_string(Color color);

/// One sRGB channel in [0, 1] to linear light, and back (IEC 61966-2-1).
double srgb_to_linear(double value);
double linear_to_srgb(double value);

/// The color in linear light, channels in [0, 1].
std::array<double, 3> to_linear(Color color);

// Compositing onto pixels with straight alpha, in encoded values.

/// Draws a color (red, green, blue) of an opacity of 0 to 255 over a pixel of four channels, rounded.
inline void put_over(const std::uint8_t* color, std::uint32_t opacity, std::uint8_t* pixel) {
    const std::uint32_t over = 255u * opacity, under = pixel[3] * (255u - opacity), sum = over + under;
    if (sum == 0) return;
    for (int c = 0; c < 3; ++c) pixel[c] = std::uint8_t((color[c] * over + pixel[c] * under + sum / 2) / sum);
    pixel[3] = std::uint8_t((sum + 127u) / 255u);
}

}  // namespace tumble
