// Pose and velocities of a body at one time; world frame.
#pragma once

#include "core/vector.h"

namespace tumble {

struct Motion {
    Vec3 position = Vec3::Zero();  // m, of the center of mass
    Vec3 velocity = Vec3::Zero();  // m/s
    Quat orientation = Quat::Identity();
    Mat3 rotation = Mat3::Identity();      // the same as a matrix
    Vec3 angular_velocity = Vec3::Zero();  // rad/s

    Vec3 to_world(const Vec3& p) const { return position + rotation * p; }
    Vec3 point_velocity(const Vec3& arm) const { return velocity + angular_velocity.cross(arm); }
};

}  // namespace tumble
