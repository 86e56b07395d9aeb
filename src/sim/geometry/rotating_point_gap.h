// How a corner comes down to a face while its body turns: along a curve. A corner of what rolls closes its gap ever more slowly, and
// comes down where the body has rolled to, not where it is when the step begins.
//
// With n the face's normal towards the corner, r the corner's arm, w its body's angular velocity (along the unit vector e), and v the
// velocity of the body's centre against the face along n, all kept for the step, the gap is
//     s(t) = s + v t + C (cos wt - 1) + D sin wt,    C = n.r - (n.e)(e.r),    D = n.(e x r).
#pragma once

#include "core/vector.h"

namespace tumble {

/// Of a body.
struct RigidMotion {
    Vec3 center = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();   // m, m/s, rad/s; world

    Vec3 at(const Vec3& point) const { return velocity + angular_velocity.cross(point - center); }
};

class Swing {
public:
    /// `gap` (m) of the corner over the face with this normal, which points towards the corner and does not turn.
    Swing(const Vec3& corner, double gap, const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face);

    /// Whether the bodies turn against each other so fast that it tells in a step of h seconds, while the face keeps its normal. A spin
    /// about the normal brings no corner down: with it, rounding would choose one of a flat body's corners.
    static bool matters(const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face, double h);

    double gap(double t) const;       // m
    double closing(double t) const;   // m/s
    double bend(double t) const;      // m/s^2: by how much the closing slows
    /// When the turn alone would bring the corner nearest within a time h, and how near.
    double bottom(double h) const;
    double gap_by_turn(double t) const { return gap(t) - v_ * t; }
    double closing_by_turn(double t) const { return closing(t) + v_; }
    /// Where the corner then is, seen from where its body's centre is now.
    Vec3 turned(double t) const;

private:
    double gap_, v_, w_, c_ = 0.0, d_ = 0.0;
    Vec3 center_, along_, across_, beside_;   // m: the centre, the arm's parts along the axis and across it, e x r
};

}  // namespace tumble
