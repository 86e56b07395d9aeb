// First intersections of a row of rays with a shape: depths in m along the camera axis, infinity without an
// intersection. Rays start at the eye, (0, 0, 0), in the camera frame (pinhole_camera.h), with direction (x, y, 1), so
// that the ray parameter is the depth. A shape that contains the eye is not visible. Double precision without fused
// operations: the same bits on every processor.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstddef>

namespace tumble {

/// Pose of a part in the camera frame: a point p of the part is at origin + axes p.
struct PartPlace {
    Mat3 axes;
    Vec3 origin;  // m

    friend bool operator==(const PartPlace&, const PartPlace&) = default;
};

/// The ends of a cord in the camera frame: its anchor and its attachment on the body.
struct CordPlace {
    Vec3 from, to;  // m

    friend bool operator==(const CordPlace&, const CordPlace&) = default;
};

/// Adjacent pixels of a row.
struct RayRow {
    const double* x = nullptr;
    double y = 0.0;
    std::size_t count = 0;
};

/// Corners of the box |p_k| <= half_size_k in the part's axes, camera frame.
std::array<Vec3, 8> corners_of(const PartPlace& place, const Vec3& half_size);

/// The box |p_k| <= half_size_k in the part's axes.
void box_depths(const PartPlace& place, const Vec3& half_size, const RayRow& rays, double* depths);

void ball_depths(const Vec3& center, double radius, const RayRow& rays, double* depths);

/// The half-space below a plane. `normal`: unit; `height`: of the eye above the plane, m.
void plane_depths(const Vec3& normal, double height, const RayRow& rays, double* depths);

/// The lateral surface of a cylinder, without caps.
void cord_depths(const CordPlace& place, double radius, const RayRow& rays, double* depths);
/// Normal of a cord at a point of its surface, in the camera frame.
Vec3 cord_normal(const CordPlace& place, const Vec3& point);

}  // namespace tumble
