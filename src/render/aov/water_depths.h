// The surface of the water under pixel centers.
#pragma once

#include "render/aov/visibility_buffer.h"
#include "scene/description/water.h"

namespace tumble {

/// m along the ray, in its lengths, from the eye to the first point where it meets the surface; infinity: none.
/// `ray`: world frame.
double water_depth(const WaterSurface& water, double time, const Vec3& eye, const Vec3& ray);

/// Puts the surface before all that is farther, with the index `surface`.
void add_water(const WaterSurface& water, double time, const PinholeCamera& camera, std::uint32_t surface,
               VisibilityBuffer& map);

}  // namespace tumble
