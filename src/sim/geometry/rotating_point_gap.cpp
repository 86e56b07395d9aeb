#include "sim/geometry/rotating_point_gap.h"

#include "core/deterministic_math.h"
#include "sim/geometry/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {

Swing::Swing(const Vec3& corner, double gap, const Vec3& normal, const RigidMotion& of_corner,
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

bool Swing::matters(const Vec3& normal, const RigidMotion& of_corner, const RigidMotion& of_face, double h) {
    const double least = tuning::swing_turn * tuning::swing_turn / (h * h);
    return of_corner.angular_velocity.cross(normal).squaredNorm() > least &&
           of_face.angular_velocity.cross(normal).squaredNorm() < least;
}

double Swing::gap(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return gap_ + v_ * t + c_ * (cosine - 1.0) + d_ * sine;
}

double Swing::closing(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return w_ * (c_ * sine - d_ * cosine) - v_;
}

double Swing::bend(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return -w_ * w_ * (c_ * cosine + d_ * sine);
}

// (C, D) = -R (cos x0, sin x0), and the rotation alone moves the corner along -R cos(wt - x0).
double Swing::bottom(double h) const { return std::clamp(atan2_stable(-d_, -c_) / w_, 0.0, h); }

Vec3 Swing::turned(double t) const {
    const auto [sine, cosine] = sincos(w_ * t);
    return center_ + along_ + cosine * across_ + sine * beside_;
}

}  // namespace tumble
