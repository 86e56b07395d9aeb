// The motion of a body between two moments, as the player computes it too (web/src/data/segment.ts).
//
// The center moves along the cubic with the velocities of both ends: exact in free fall. The rotation is a uniform one
// from end to end, followed by a small one that has the angular velocities of both ends, and the angular accelerations
// of a torque-free body: exact for a uniform spin, and of sixth order in the time between the moments otherwise.
#pragma once

#include "core/vector.h"

namespace tumble {

struct Moment {
    double time = 0.0;             // s
    Vec3 position = Vec3::Zero();  // m
    Quat rotation = Quat::Identity();
    Vec3 velocity = Vec3::Zero();          // m/s
    Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

/// A rotation vector (rad) as a rotation.
Quat turn_by(const Vec3& turn);
/// The rotation vector of a rotation, at most half a turn.
Vec3 turn_of(const Quat& rotation);
/// Angle between two rotations, rad; precise for small ones.
double angle_between(const Quat& a, const Quat& b);

/// Angular acceleration of a torque-free body with that inertia (body frame, kg m^2); zero inertia: none.
Vec3 free_angular_acceleration(const Mat3& inertia, const Quat& rotation, const Vec3& angular_velocity);

class MotionSegment {
public:
    /// `inertia`: body frame, kg m^2; zero: without angular accelerations.
    MotionSegment(const Moment& start, const Moment& end, const Mat3& inertia);
    Moment at(double time) const;

private:
    Moment start_, end_;
    Vec3 turn_;                                   // rad, from start to end
    Vec3 rate_start_, rate_end_;                  // rad/s, of the small rotation
    Vec3 acceleration_start_, acceleration_end_;  // rad/s^2
};

}  // namespace tumble
