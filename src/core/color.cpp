#include "core/color.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace tumble {

std::optional<Color> parse_color(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    std::array<std::uint8_t, 3> channel{};
    for (std::size_t i = 0; i < 3; ++i) {
        const char* first = text.data() + 1 + 2 * i;
        const auto [end, error] = std::from_chars(first, first + 2, channel[i], 16);
        if (error != std::errc() || end != first + 2) return std::nullopt;
    }
    return Color{channel[0], channel[1], channel[2]};
}

std::string to_string(Color color) { return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b); }

double srgb_to_linear(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double value) {
    return value <= 0.0031308 ? value * 12.92 : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
}

std::array<double, 3> to_linear(Color color) {
    return {srgb_to_linear(color.r / 255.0), srgb_to_linear(color.g / 255.0), srgb_to_linear(color.b / 255.0)};
}

}  // namespace tumble
