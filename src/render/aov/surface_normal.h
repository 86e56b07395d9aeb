// The outward normal of the surface that a pixel shows; of an open mesh seen from inside, the normal towards the eye.
#pragma once

#include "render/aov/visibility_buffer.h"

namespace tumble {

/// Unit, in the part's frame (exact for an axis-aligned box), at the intersection of a ray (x, y, 1) at a depth. Boxes
/// and planes have face normals; a mesh has its shading normal, interpolated between the corners.
Vec3 part_normal(const ShapeInstance& part, const PartPlace& place, std::uint32_t triangle, const Vec3& ray,
                 double depth);

/// Normal of a cord, in the camera frame.
Vec3 cord_normal(const CordPlace& place, const Vec3& point);

}  // namespace tumble
