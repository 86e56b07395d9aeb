// Several lights.
#pragma once

#include "scene/description/description.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace tumble {

/// The index of the sun that has shadows, or else of the first sun: the LightDescription of the scene. Empty: none.
inline std::optional<std::size_t> main_sun(const std::vector<LampDescription>& lamps) {
    auto found = std::ranges::find(lamps, true, &LampDescription::shadows);
    if (found == lamps.end()) found = std::ranges::find(lamps, LightType::sun, &LampDescription::type);
    if (found == lamps.end()) return std::nullopt;
    return std::size_t(found - lamps.begin());
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
