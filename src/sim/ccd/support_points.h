// A convex shape at one moment as the search for impacts sees it: a cloud of points about its centre, rounded by a
// radius, with what bounds its motion from then on. A ball is one point with a radius, a polyhedron its vertices, a
// half-space the point of its plane below the other body.
#pragma once

#include "sim/ccd/motion.h"
#include "sim/ccd/trajectory.h"

#include <vector>

namespace tumble {

struct SupportPoints {
    Vec3 center = Vec3::Zero();             // m, world
    Vec3 velocity = Vec3::Zero();           // m/s, of the centre
    Vec3 acceleration = Vec3::Zero();       // m/s^2, of the centre
    double acceleration_change = 0.0;       // m/s^2: the acceleration stays within this of the present one
    Vec3 angular_velocity = Vec3::Zero();   // rad/s
    double spin_bound = 0.0;                // rad/s, as Trajectory's
    double turning_bound = 0.0;             // rad/s^2
    double radius = 0.0;                    // m, of the rounding
    double reach = 0.0;                     // m, of the farthest arm
    std::vector<Vec3> arms;                 // m, from the centre, world axes

    Vec3 arm_velocity(std::size_t i) const { return angular_velocity.cross(arms[i]); }
};

/// An axis between two clouds, from A to B, that turns with the features it separates.
struct Axis {
    Vec3 normal = Vec3::UnitY();   // unit
    Vec3 rate = Vec3::Zero();      // 1/s, across the normal
};

}  // namespace tumble
