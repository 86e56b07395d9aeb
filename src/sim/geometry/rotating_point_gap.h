// Gap of a corner over a face while its body rotates, along a curve. A corner of a rolling body closes its gap ever
// more slowly, and lands where the body has rolled to, not where it is at the start of the step.
//
// With n the face's normal towards the corner, r the corner's arm, w its body's angular velocity (along the unit vector
// e), and v the velocity of the body's center relative to the face along n, all constant for the step, the gap is
//   s(t) = s + v t + C (cos wt - 1) + D sin wt,    C = n.r - (n.e)(e.r),    D = n.(e x r).
#pragma once

#include "core/vector.h"

namespace tumble {

/// Motion of a body at one time.
struct RigidMotion {
    Vec3 center = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  // m, m/s, rad/s; world

    Vec3 at(const Vec3& point) const { return velocity + angular_velocity.cross(point - center); }
};

class Swing {
public:
    /// `gap` (m): of the corner over the face with this normal, which points towards the corner and does not rotate.
    Swing(const Vec3& corner, double gap, const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face);

    /// Whether the relative rotation of the bodies is fast enough to matter in a step of h seconds, while the face
    /// keeps its normal. A spin about the normal lowers no corner: with it, rounding would choose one of a flat body's
    /// corners.
    static bool matters(const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face, double h);

    double gap(double t) const;      // m
    double closing(double t) const;  // m/s
    double bend(double t) const;     // m/s^2: deceleration of the closing
    /// Time (s, at most h) at which the rotation alone would bring the corner nearest; its gap is that of this time.
    double bottom(double h) const;
    double gap_by_turn(double t) const { return gap(t) - v_ * t; }
    double closing_by_turn(double t) const { return closing(t) + v_; }
    /// Position of the corner at time t, relative to the present center of its body.
    Vec3 turned(double t) const;

private:
    double gap_, v_, w_, c_ = 0.0, d_ = 0.0;
    Vec3 center_, along_, across_, beside_;  // m: the center, the arm's components along and across the axis, e x r
};

}  // namespace tumble
