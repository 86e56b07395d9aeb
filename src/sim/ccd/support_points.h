// Support points: a convex shape at one time for the search for impacts. Points about a center, rounded by a radius,
// with bounds of their further motion. A ball is one point with a radius, a polyhedron its vertices, a half-space the
// point of its plane below the other body.
#pragma once

#include "sim/ccd/motion.h"
#include "sim/ccd/trajectory.h"

#include <vector>

namespace tumble {

struct SupportPoints {
    Vec3 center = Vec3::Zero();            // m, world
    Vec3 velocity = Vec3::Zero();          // m/s, of the center
    Vec3 acceleration = Vec3::Zero();      // m/s^2, of the center
    double acceleration_change = 0.0;      // m/s^2: bound of the deviation of the acceleration from the present one
    Vec3 angular_velocity = Vec3::Zero();  // rad/s
    double spin_bound = 0.0;               // rad/s, Trajectory::spin_bound()
    double turning_bound = 0.0;            // rad/s^2, Trajectory::turning_bound()
    double radius = 0.0;                   // m, of the rounding
    double reach = 0.0;                    // m, length of the longest arm
    std::vector<Vec3> arms;                // m, from the center, world axes

    Vec3 arm_velocity(std::size_t i) const { return angular_velocity.cross(arms[i]); }
};

/// An axis from A to B that rotates with the features that it separates.
struct Axis {
    Vec3 normal = Vec3::UnitY();  // unit
    Vec3 rate = Vec3::Zero();     // 1/s, perpendicular to the normal
};

}  // namespace tumble
