// The path of a kinematic body: smooth through its keyframes, at rest before the first and after the last.
// Position: cubic Hermite spline with Catmull-Rom tangents for nonuniform times, limited against overshoot: between two
// equal keys the body stands still.
// Rotation: the same in rotation vectors of each segment, q(u) = q_i exp(phi(u)), so that the angular velocity is
// continuous and uniformly spaced keys of a steady rotation give a steady rotation.
// Linear: constant velocity and angular velocity between keys.
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"

#include <vector>

namespace tumble {

class KeyframeTrack {
public:
    /// Precondition: at least one key, in increasing time. Rotations take the shorter arc from key to key.
    KeyframeTrack(std::vector<Keyframe> keys, Interpolation interpolation);

    struct Motion {
        Vec3 position;
        Quat rotation;
        Vec3 velocity;          // m/s, of the origin
        Vec3 angular_velocity;  // rad/s, world frame
    };
    Motion at(double time) const;

    struct Acceleration {
        Vec3 linear = Vec3::Zero();   // m/s^2, of the origin
        Vec3 angular = Vec3::Zero();  // rad/s^2, world frame
    };
    /// The motion at a time, by the part of the path between two keys that holds the time `within`: on both sides of a
    /// key.
    Motion at(double time, double within) const;
    Acceleration acceleration(double time, double within) const;
    /// The first key after a time, s; infinity: none.
    double next_key(double time) const;
    /// True if the velocity is continuous.
    bool smooth() const { return smooth_; }

private:
    std::size_t segment(double time) const;  // that holds the time, between the first key and the last
    Motion on(std::size_t segment, double u) const;
    std::vector<Keyframe> keys_;
    std::vector<Vec3> velocity_;  // tangents at the keys, m/s
    std::vector<Vec3> turn_;      // segment i: rotation vector from key i to i + 1, in key i's frame
    std::vector<Vec3> spin_;      // angular velocity at the keys, in the key's frame, rad/s
    bool smooth_;
};

/// The rotation vector (axis times angle, |angle| <= pi) of a unit quaternion, and back.
Vec3 rotation_vector(const Quat& q);
Quat from_rotation_vector(const Vec3& v);

/// The angular velocity of a rotation exp(phi) in its own frame, from the rate of phi, and back.
Vec3 body_spin(const Vec3& phi, const Vec3& rate);
Vec3 rate_from_spin(const Vec3& phi, const Vec3& spin);

}  // namespace tumble
