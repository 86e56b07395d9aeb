// Several lights.
#pragma once

#include "scene/description/description.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

/// The index of the first sun that has shadows, or else of the first sun: the LightDescription of the scene. Empty:
/// none.
inline std::optional<std::size_t> main_sun(const std::vector<LampDescription>& lamps) {
    const auto is_sun = [](const LampDescription& lamp) { return lamp.type == LightType::sun; };
    auto found = std::ranges::find_if(lamps, [&](const LampDescription& lamp) { return is_sun(lamp) && lamp.shadows; });
    if (found == lamps.end()) found = std::ranges::find_if(lamps, is_sun);
    if (found == lamps.end()) return std::nullopt;
    return std::size_t(found - lamps.begin());
}

/// The index of the light that throws the shadows of shaders/lamp_shadow.glsl; the main sun has its own shadow map.
inline std::optional<std::size_t> second_shadow(const std::vector<LampDescription>& lamps) {
    const std::optional<std::size_t> sun = main_sun(lamps);
    for (std::size_t i = 0; i < lamps.size(); ++i)
        if (lamps[i].shadows && i != sun) return i;
    return std::nullopt;
}

/// Irradiance over pi, linear: of a sun anywhere, of another light at a distance of 1 m. Suns of [light] have that of
/// shaders/light_constants.glsl, which is that of the defaults here but for the rounding of their color.
inline std::array<double, 3> strength_of(const LampDescription& lamp) {
    constexpr double of_one = 0.8;
    std::array<double, 3> strength = to_linear(lamp.color);
    for (double& channel : strength) channel *= of_one * lamp.intensity;
    return strength;
}

}  // namespace tumble
