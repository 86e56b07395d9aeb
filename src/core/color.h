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

}  // namespace tumble
