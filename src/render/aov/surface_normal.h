// The outward normal of what a pixel shows; of an open mesh seen from inside, that towards the eye.
#pragma once

#include "render/aov/visibility_buffer.h"

namespace tumble {

/// Unit, in the part's own frame (so that a level box's are exact), where a ray (x, y, 1) meets it at a depth. Boxes and
/// planes are flat; a mesh has the normals it is shaded with, those of its corners in their shares.
Vec3 part_normal(const ShapeInstance& part, const PartPlace& place, std::uint32_t triangle, const Vec3& ray, double depth);

/// Of a cord, in the camera's frame.
Vec3 cord_normal(const CordPlace& place, const Vec3& point);

}  // namespace tumble
