// How far along a row of rays a shape is first entered: depths in m along the camera's axis, infinity where it is not.
// Rays start at the eye, (0, 0, 0), in the camera's frame (pinhole_camera.h), and are (x, y, 1), so that the distance
// in ray lengths is the depth. A shape that the eye is in is not seen. Double precision, without fused operations: the
// same bits on every processor.
#pragma once

#include "core/vector.h"
#include "render/aov/shape_instance.h"

#include <cstddef>

namespace tumble {

/// Pixels next to each other.
struct RayRow {
    const double* x = nullptr;
    double y = 0.0;
    std::size_t count = 0;
};

/// The box |p_k| <= half_size_k of the part's axes.
void box_depths(const PartPlace& place, const Vec3& half_size, const RayRow& rays, double* depths);

void ball_depths(const Vec3& center, double radius, const RayRow& rays, double* depths);

/// The half-space below a plane: `normal` is unit, `height` that of the eye above it.
void plane_depths(const Vec3& normal, double height, const RayRow& rays, double* depths);

/// The side of a cylinder; its ends are open.
void cord_depths(const CordPlace& place, double radius, const RayRow& rays, double* depths);

}  // namespace tumble
