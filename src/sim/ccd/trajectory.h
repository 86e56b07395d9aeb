// Trajectory of a body between two events: its center on a polynomial of time, its orientation constant, rotating
// uniformly, in free rotation, or along a polynomial. All queries between two events use it; it is always evaluated
// from its start, so that rounding does not accumulate.
#pragma once

#include "core/vector.h"
#include "sim/math/free_rotation.h"

#include <optional>
#include <variant>

namespace tumble {

// A rotation that changes its speed and axis: the rotation vector from its start is cubic in time (Hermite), through
// the orientations and angular velocities of both ends. Error O(span^4) in between.

struct CurvedRotation {
    Quat from = Quat::Identity();
    Vec3 rate = Vec3::Zero(), bend = Vec3::Zero(), twist = Vec3::Zero();  // derivatives of the rotation vector at 0

    struct End {
        Quat orientation;
        Vec3 angular_velocity;  // rad/s
    };
    /// Between two ends `span` s apart; none where the rotation is too large for one vector.
    static std::optional<CurvedRotation> between(const End& start, const End& end, double span);

    Vec3 vector(double t) const { return t * (rate + t * (0.5 * bend + t / 6.0 * twist)); }
    Vec3 vector_rate(double t) const { return rate + t * (bend + 0.5 * t * twist); }
    Quat orientation(double t) const;
    Vec3 angular_velocity(double t) const;

    /// Upper bounds up to time `span`: of |omega| (rad/s), and of |omega|^2 + |alpha| (rad/s^2).
    double spin_bound(double span) const;
    double turning_bound(double span) const;

    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [from, rate, bend, twist] = self;
        archive.keep(from, rate, bend, twist);
    }
};

/// Pose and velocities of a body at one time; world frame.
struct Motion {
    Vec3 position = Vec3::Zero();  // m, of the center of mass
    Vec3 velocity = Vec3::Zero();  // m/s
    Quat orientation = Quat::Identity();
    Mat3 rotation = Mat3::Identity();      // the same as a matrix
    Vec3 angular_velocity = Vec3::Zero();  // rad/s

    Vec3 to_world(const Vec3& p) const { return position + rotation * p; }
    Vec3 point_velocity(const Vec3& arm) const { return velocity + angular_velocity.cross(arm); }
};

struct Body;

struct UniformRotation {
    Quat from = Quat::Identity();
    Vec3 axis = Vec3::UnitY();
    double rate = 0.0;  // rad/s
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [from, axis, rate] = self;
        archive.keep(from, axis, rate);
    }
};
struct TorqueFreeRotation {
    FreeRotation rotation;
    Mat3 inverse_inertia = Mat3::Zero();   // body frame
    Vec3 angular_momentum = Vec3::Zero();  // world
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [rotation, inverse_inertia, angular_momentum] = self;
        archive.keep(rotation, inverse_inertia, angular_momentum);
    }
};

class Trajectory {
public:
    Trajectory() = default;

    /// Free flight from the body's present state under a constant acceleration (m/s^2): a parabola and torque-free
    /// rotation, both in closed form.
    static Trajectory flight(const Body& body, const Vec3& acceleration);
    /// The same with a constant velocity of the center (m/s).
    static Trajectory drift(const Body& body, const Vec3& velocity);
    /// From the body's present pose with constant velocities (m/s, rad/s).
    static Trajectory uniform(const Body& body, const Vec3& velocity, const Vec3& angular_velocity);
    /// From the body's present pose to the motion `end` after `span` s without torque: cubic in the center (Hermite),
    /// error O(span^4) in between, and free rotation in closed form.
    static Trajectory towards(const Body& body, const Motion& end, double span);
    /// From the body's present motion to the motion `end` after `span` s: cubic in the center and in the rotation
    /// vector, error O(span^4) in between. Turns of a radian and more are uniform, with an error O(span^2).
    static Trajectory between(const Body& body, const Motion& end, double span);

    /// The same rotation, but from time t with another velocity of the center: after an impact through the center.
    Trajectory deflected(double t, const Vec3& velocity) const;

    /// t: s since the start of the trajectory.
    Vec3 position(double t) const { return start_ + t * (velocity_ + t * (0.5 * acceleration_ + t / 6.0 * jerk_)); }
    Vec3 velocity(double t) const { return velocity_ + t * (acceleration_ + 0.5 * t * jerk_); }
    Vec3 acceleration(double t) const { return acceleration_ + t * jerk_; }
    Quat orientation(double t) const;
    Motion at(double t) const;

    /// Bounds of the center's path between two times.
    Bounds swept(double from, double to) const;

    bool parabolic() const { return jerk_.isZero(0.0); }
    bool still() const {
        return spin_bound_ == 0.0 && velocity_.isZero(0.0) && acceleration_.isZero(0.0) && parabolic();
    }
    bool turns() const { return spin_bound_ > 0.0; }
    /// Upper bound of |omega| (rad/s) over the trajectory.
    double spin_bound() const { return spin_bound_; }
    /// Upper bound of |omega|^2 + |alpha| (rad/s^2): times r it bounds the acceleration of a point at distance r from
    /// the center.
    double turning_bound() const { return turning_bound_; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [start, velocity, acceleration, jerk, turning, turned, spin_bound, turning_bound] = self;
        archive.keep(start, velocity, acceleration, jerk, turning, turned, spin_bound, turning_bound);
    }

private:
    Vec3 start_ = Vec3::Zero(), velocity_ = Vec3::Zero(), acceleration_ = Vec3::Zero(), jerk_ = Vec3::Zero();
    std::variant<UniformRotation, TorqueFreeRotation, CurvedRotation> turning_;
    double turned_ = 0.0;  // s, duration of the rotation before the start of the trajectory
    double spin_bound_ = 0.0, turning_bound_ = 0.0;

    void turn_uniformly(const Quat& from, const Vec3& angular_velocity);
    void turn_freely(const Body& body);
    void move_along_cubic(const Body& body, const Motion& end, double span);
};

}  // namespace tumble
