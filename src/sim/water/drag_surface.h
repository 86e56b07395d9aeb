// The surface by which water brakes a body: triangles around its convex parts, scaled to their true areas.
//
// An element dA of the surface of the wet part, with the normal n and the velocity w relative to the water, takes
//
//   dF = -1/2 rho C 1/2 |n . w| w dA,
//
// on flat faces half of it along the normal. A curved convex part that does not turn takes -1/2 rho C A |v| v, with A
// the area that it shows to the flow: half of the sum of |n . v| over its surface. The plane of the water closes the
// wet part. Each element takes energy, so that turning is braked too.
#pragma once

#include "sim/math/wrench.h"
#include "sim/water/hull_parts.h"
#include "sim/water/wet_volume.h"

#include <cmath>
#include <vector>

namespace tumble {

/// A motion of a body relative to water, in the body's frame.
struct FlowPast {
    Vec3 velocity = Vec3::Zero();          // m/s, at the origin
    Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

struct DragIntegral {
    Vec3 force = Vec3::Zero();         // m^4/s^2: without -1/2 rho C
    Vec3 torque = Vec3::Zero();        // m^5/s^2, about the origin of the frame
    double plane = 0.0;                // m^2, area of the cut by the water
    Vec3 plane_moment = Vec3::Zero();  // m^3, the area times its center
    /// m^3/s and m^4/s: the normal velocity of the cut along its normal, and the moment of that.
    Vec3 heave = Vec3::Zero(), roll = Vec3::Zero();
};

/// The share of the force that acts against the motion; the rest is pressure along the normal. A cube that
/// moves edge first takes 3/4 of the force by its area (measured: 0.8 to 1.05 in C, Hoerner 1965, "Fluid-Dynamic
/// Drag"), and a plate at an angle is lifted: swimmers get their thrust by it. On curved faces all of it acts against
/// the motion.
inline double drag_share(const HullPart& part) { return part.flat() ? 0.5 : 1.0; }

/// Without -1/2 rho C, of a part `weight` of twice an element `area` (m^2, along its normal, not zero). `w`: m/s, its
/// velocity; `past`: m/s, as far as it moves the surface through the water.
inline Vec3 element_drag(double weight, const Vec3& area, double share, const Vec3& w, const Vec3& past) {
    return weight * std::abs(area.dot(past)) * (share * w + (1.0 - share) / area.squaredNorm() * area.dot(w) * area);
}

class DragSurface {
public:
    DragSurface() = default;
    /// Precondition: a shape that can move.
    explicit DragSurface(const CollisionShape& shape);

    /// All in the frame of the shape.
    DragIntegral drag(const WaterPlane& plane, const FlowPast& flow) const;

private:
    DragIntegral drag_of(const HullPart& part, const WaterPlane& plane, const FlowPast& flow) const;

    std::vector<HullPart> parts_;
};

}  // namespace tumble
