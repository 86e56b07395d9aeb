// The surface by which water brakes a body: triangles around its convex parts.
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
#include "sim/water/wet_volume.h"

#include <array>
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

class DragSurface {
public:
    DragSurface() = default;
    /// Precondition: a shape that can move.
    explicit DragSurface(const CollisionShape& shape);

    /// All in the frame of the shape.
    DragIntegral drag(const WaterPlane& plane, const FlowPast& flow) const;

private:
    struct Part {
        std::vector<Vec3> vertices;                           // m, the shape's frame
        std::vector<std::array<std::uint32_t, 3>> triangles;  // counterclockwise seen from outside
        double scale = 1.0;                                   // on areas: a curved surface is larger than its triangles
        double ball = 0.0;                                    // m, in place of triangles
        Vec3 center = Vec3::Zero();                           // m, of a ball or on the axis
        Vec3 axis = Vec3::Zero();                             // unit, of a surface of revolution; zero for others
    };

    DragIntegral drag_of(const Part& part, const WaterPlane& plane, const FlowPast& flow) const;
    void add(const CollisionShape& shape, const Pose& place);

    std::vector<Part> parts_;
};

}  // namespace tumble
