// The surroundings of a scene: its background, and the light from all sides.
#pragma once

#include "core/color.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace tumble {

/// Radiance from all directions, linear and relative as all light (1 on a white surface is paper white): an
/// equirectangular image with rows from straight up to straight down and columns from -x by -z to +x and +z, so that
/// its middle is +x.
struct EnvironmentImage {
    int width = 0, height = 0;
    std::vector<std::array<float, 3>> texels;

    const std::array<float, 3>& at(int x, int y) const {
        return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
};

enum class BackgroundKind : std::uint8_t { sky, colors, image };

struct EnvironmentDescription {
    BackgroundKind background = BackgroundKind::sky;
    Color low{}, high{};                            // of the horizon and of the zenith; the same for a plain color
    std::shared_ptr<const EnvironmentImage> image;  // null: the light of the sky
    double rotation = 0.0;                          // degrees about y, counter-clockwise seen from above
    double intensity = 1.0;                         // factor on the image
    double blur = 0.0;                              // of the image as background: 0 to 1
    std::array<double, 3> sun{1.0, 1.0, 1.0};       // factor on the light of the sun, which goes with a preset
    bool ground_shadow = false;                     // planes show shadows only, on the background
};

/// From linear light to the screen. filmic: colors up to 0.6 as they are, then a shoulder; linear: cut off at white.
enum class ToneCurve : std::uint8_t { filmic, linear };

}  // namespace tumble
