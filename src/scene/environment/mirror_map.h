// The light of an environment as surfaces of several roughnesses mirror it.
#pragma once

#include "core/vector.h"
#include "scene/description/environment.h"

#include <array>
#include <vector>

namespace tumble {

/// Octahedral maps (world frame, up in their middle), each with a rim of one texel that continues it: a sharp one of
/// 128 x 128 texels, and below it pairs of 64 x 64 with growing roughness. shaders/environment.glsl reads them.
struct MirrorMap {
    static constexpr int sharp_side = 128, rough_side = 64, rough_count = 8;
    static constexpr int width = sharp_side, height = sharp_side + rough_count / 2 * rough_side;
    std::vector<std::array<float, 4>> texels;  // red, green, blue, 1
};

/// With the rotation and intensity of the environment, which has an image.
MirrorMap make_mirror_map(const EnvironmentDescription& environment);

/// The image of the environment as its background shows it: with intensity and blur, not rotated.
EnvironmentImage blurred_background(const EnvironmentDescription& environment);

}  // namespace tumble
