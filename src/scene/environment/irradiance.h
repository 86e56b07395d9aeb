// The light that an environment throws on a surface, by its normal.
#pragma once

#include "core/vector.h"
#include "scene/description/environment.h"

#include <array>

namespace tumble {

/// Factors of 1, x, y, z, xy, yz, xz, z^2 and x^2 - y^2 of the unit normal (world frame), whose sum is the irradiance
/// over pi: red, green, blue.
using Irradiance = std::array<std::array<float, 3>, 9>;

/// By spherical harmonics up to the second order, to 1 % of the largest irradiance. With the rotation and intensity of
/// the environment, which has an image.
Irradiance irradiance_of(const EnvironmentDescription& environment);

/// The direction from the middle of a texel, unit, image frame.
Vec3 direction_of_texel(const EnvironmentImage& image, int x, int y);

}  // namespace tumble
