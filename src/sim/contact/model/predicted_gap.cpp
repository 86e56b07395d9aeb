#include "sim/contact/model/predicted_gap.h"

#include "core/deterministic_math.h"
#include "sim/geometry/settings.h"
#include "sim/geometry/shapes/curved.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace tumble {
namespace {

/// A curve that passes an edge may overlap it by this share of the smaller radius: tiles may have sunk into their
/// support by as much. A larger overlap is a hit. Related tests: Seam.DoesNotCatchBalls and
/// PredictedGap.ANearMissChangesNothing.
constexpr double predicted_gap_overlap = 2e-3;

// Motion of a body at one time.
struct RigidMotion {
    Vec3 center = Vec3::Zero(), velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  // m, m/s, rad/s; world

    Vec3 at(const Vec3& point) const { return velocity + angular_velocity.cross(point - center); }
};

// Gap of a corner over a face while its body rotates, along a curve. A corner of a rolling body closes its gap ever
// more slowly, and lands where the body has rolled to, not where it is at the start of the step.
//
// With n the face's normal towards the corner, r the corner's arm, w its body's angular velocity (along the unit vector
// e), and v the velocity of the body's center relative to the face along n, all constant for the step, the gap is
//   s(t) = s + v t + C (cos wt - 1) + D sin wt,    C = n.r - (n.e)(e.r),    D = n.(e x r).
class RotatingPointGap {
public:
    // `gap` (m): of the corner over the face with this normal, which points towards the corner and does not rotate.
    RotatingPointGap(const Vec3& corner, double gap, const Vec3& normal, const RigidMotion& of_corner,
                     const RigidMotion& of_face);

    // True if the relative rotation of the bodies is fast enough to matter in a step of h seconds, while the face
    // keeps its normal. A spin about the normal lowers no corner: with it, rounding would choose one of a flat body's
    // corners.
    static bool matters(const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face, double h);

    double gap(double t) const;      // m
    double closing(double t) const;  // m/s
    double bend(double t) const;     // m/s^2: deceleration of the closing
    // Time (s, at most h) at which the rotation alone would bring the corner nearest; its gap is that of this time.
    double bottom(double h) const;
    double gap_by_turn(double t) const { return gap(t) - v_ * t; }
    double closing_by_turn(double t) const { return closing(t) + v_; }
    // Position of the corner at time t, relative to the present center of its body.
    Vec3 turned(double t) const;

private:
    double gap_, v_, w_, c_ = 0.0, d_ = 0.0;
    Vec3 center_, along_, across_, beside_;  // m: the center, the arm's components along and across the axis, e x r
};

RotatingPointGap::RotatingPointGap(const Vec3& corner, double gap, const Vec3& normal, const RigidMotion& of_corner,
                                   const RigidMotion& of_face)
    : gap_(gap),
      v_(normal.dot(of_corner.velocity - of_face.at(corner))),
      w_(of_corner.angular_velocity.norm()),
      center_(of_corner.center),
      along_(corner - of_corner.center),
      across_(Vec3::Zero()),
      beside_(Vec3::Zero()) {
    if (!(w_ > 0.0)) return;
    const Vec3 axis = of_corner.angular_velocity / w_, arm = along_;
    along_ = axis.dot(arm) * axis;
    across_ = arm - along_;
    beside_ = axis.cross(arm);
    c_ = normal.dot(across_);
    d_ = normal.dot(beside_);
}

bool RotatingPointGap::matters(const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face, double h) {
    const double least = tuning::fast_rotation_turn * tuning::fast_rotation_turn / (h * h);
    return of_corner.angular_velocity.cross(normal).squaredNorm() > least &&
           of_face.angular_velocity.cross(normal).squaredNorm() < least;
}

double RotatingPointGap::gap(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return gap_ + v_ * t + c_ * (cosine - 1.0) + d_ * sine;
}

double RotatingPointGap::closing(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return w_ * (c_ * sine - d_ * cosine) - v_;
}

double RotatingPointGap::bend(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return -w_ * w_ * (c_ * cosine + d_ * sine);
}

// (C, D) = -R (cos x0, sin x0), and the rotation alone moves the corner along -R cos(wt - x0).
double RotatingPointGap::bottom(double h) const { return std::clamp(atan2_stable(-d_, -c_) / w_, 0.0, h); }

Vec3 RotatingPointGap::turned(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return center_ + along_ + cosine * across_ + sine * beside_;
}

// With d the distance vector of the points across the line, initially d0 n, and u the relative velocity of the points
// across the line, |d0 n + u t| is least at t = -d0 n.u / u^2, or at the end of the step.
// If that is an overlap, the bodies do meet.
double gap_of_curve(const Manifold& m, const CurvedGap& curve, const BodiesInStep& bodies, double h) {
    const auto& [a, b, before_a, before_b] = bodies;
    const double gap = m.points[0].separation;
    if (!(gap > 0.0)) return gap;
    const auto velocity = [](const BodyVelocity& v, const Vec3& arm) {
        return Vec3(v.velocity + v.angular_velocity.cross(arm));
    };
    Vec3 u = velocity(before_b, curve.on_b - b.position) - velocity(before_a, curve.on_a - a.position);
    u -= curve.line.dot(u) * curve.line;
    const double closing = -m.normal.dot(u), d = curve.distance, square = u.squaredNorm();
    if (!(closing * h > gap)) return gap;
    const double t = std::min(h, d * closing / square);
    const double nearest = std::sqrt(std::max(0.0, d * d - 2.0 * d * closing * t + square * t * t)) - (d - gap);
    return nearest < -predicted_gap_overlap * std::min(a.radius, b.radius) ? gap : std::max(gap, nearest + h * closing);
}

RigidMotion motion_of(const Body& body, const BodyVelocity& before) {
    if (!body.moves()) return {};
    return {body.position, before.velocity, before.angular_velocity};
}

}  // namespace

PredictedGap predicted_gap(const Manifold& m, int index, const BodiesInStep& bodies, double h) {
    const auto& [a, b, before_a, before_b] = bodies;
    const ContactPoint& p = m.points[std::size_t(index)];
    const PredictedGap as_it_is{p.position, p.separation, 0.0};
    if (m.has_curved_gap()) return {p.position, gap_of_curve(m, std::get<CurvedGap>(m.geometry()), bodies, h), 0.0};
    if (m.corners == Corners::neither) return as_it_is;
    const double least = tuning::fast_rotation_turn * tuning::fast_rotation_turn, square = h * h;
    if (square * before_a.angular_velocity.squaredNorm() < least &&
        square * before_b.angular_velocity.squaredNorm() < least)
        return as_it_is;
    const bool of_a = m.corners == Corners::of_a;
    const RigidMotion on_a = motion_of(a, before_a), on_b = motion_of(b, before_b);
    const RigidMotion &corner = of_a ? on_a : on_b, &face = of_a ? on_b : on_a;
    const Vec3 normal = of_a ? Vec3(-m.normal) : m.normal;
    if (!RotatingPointGap::matters(normal, corner, face, h)) return as_it_is;
    const RotatingPointGap gap(p.position, p.separation, normal, corner, face);
    const double closing = gap.closing(0.0);
    if (!(closing * h > p.separation) || !(closing > 0.0) || !(gap.bend(0.0) > 0.0)) return as_it_is;
    double deepest = 0.0;
    for (int i = 0; i < m.count; ++i) deepest = std::min(deepest, m.points[std::size_t(i)].separation);
    const double bottom = gap.bottom(h), reach = gap.gap_by_turn(bottom);
    if (!(bottom > 0.0)) return as_it_is;
    // Height of the path half a step before its bottom: a body that rolls over more than one corner per step may pass
    // by that much below the deepest point. Deeper is an impact.
    const double passed =
        std::min(predicted_gap_overlap * std::min(a.radius, b.radius), 0.125 * h * h * gap.bend(bottom));
    if (reach < deepest - passed) return as_it_is;
    const double then = std::max(0.0, gap.closing_by_turn(bottom));
    return {gap.turned(bottom), std::min(0.0, p.separation) + h * (then + std::max(0.0, reach) / bottom),
            closing - gap.closing(bottom)};
}

// With r = r_e + r_x along and across the unit vector e of w:
//   r(h) - r - h w x r = (cos wh - 1) r_x + (sin wh - wh) e x r.
Vec3 arc_velocity(const Manifold& m, const BodiesInStep& bodies, double h) {
    if (!m.has_ball_over_face()) return Vec3::Zero();
    auto ball = std::get<BallOverFace>(m.geometry());
    if (m.count == 2) ball.center = 0.5 * (ball.center + std::get<BallOverFace>(m.geometry(1)).center);
    const auto& [a, b, before_a, before_b] = bodies;
    const bool of_a = ball.ball_of_a;
    const Body &body = of_a ? a : b, &face = of_a ? b : a;
    const Vec3 &turn = of_a ? before_a.angular_velocity : before_b.angular_velocity,
               &face_turn = of_a ? before_b.angular_velocity : before_a.angular_velocity;
    // The ball of a cylinder or a cone is centered on its axis, at no fixed point where the body tilts.
    const auto* curved = std::get_if<std::shared_ptr<const CurvedBody>>(&body.collider);
    if (curved && (*curved)->rounding == 0.0) return Vec3::Zero();
    const Vec3 arm = ball.center - body.position;
    const double w = turn.norm();
    if (!body.dynamic() || !(w > 0.0) || arm.isZero(0.0)) return Vec3::Zero();
    if (face.moves() && h * face_turn.norm() > tuning::fast_rotation_turn)
        return Vec3::Zero();  // the face's rotation matters too
    const Vec3 axis = turn / w, beside = axis.cross(arm), across = arm - axis.dot(arm) * axis;
    const auto [sine, cosine] = sincos(w * h);
    const Vec3 round = ((cosine - 1.0) * across + (sine - w * h) * beside) / h;
    return of_a ? Vec3(-round) : round;
}

}  // namespace tumble
