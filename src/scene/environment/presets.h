// Environments that need no file.
#pragma once

#include "scene/description/environment.h"

#include <array>
#include <memory>
#include <string_view>

namespace tumble {

inline constexpr std::array<std::string_view, 3> environment_presets{"studio", "overcast", "dusk"};

struct EnvironmentPreset {
    std::shared_ptr<const EnvironmentImage> image;
    std::array<double, 3> sun;  // factor on the light of the sun
};
EnvironmentPreset environment_preset(std::string_view name);

}  // namespace tumble
