#include "sim/spin_limit.h"

#include "sim/free_rotation.h"
#include "sim/tuning.h"

#include <cmath>

namespace tumble {
namespace {

Vec3 by_series(const Body& body, const Vec3& change, double h, RotationForm form) {
    const Vec3 &omega = body.angular_velocity, &l = body.angular_momentum;
    // I^-1 turns with the body: (I^-1)' = omega* I^-1 - I^-1 omega*.
    const Vec3 second = omega.cross(change) - body.inverse_inertia * (omega.cross(l.cross(omega))) + body.inverse_inertia * l.cross(change);
    const Vec3 mean = omega + 0.5 * h * change + h * h / 6.0 * second + h * h / 12.0 * change.cross(omega);
    // tan(x) / x, with half the angle for quaternions: advance_pose() turns by the angle's tangent.
    const double angle_square = h * h * mean.squaredNorm(), x = form == RotationForm::quaternion ? 0.25 * angle_square : angle_square;
    return (1.0 + x / 3.0 + x * x * 2.0 / 15.0) * mean;
}

Vec3 in_closed_form(const Body& body, double h, RotationForm form) {
    const FreeRotation rotation(body.principal_inertia, body.principal_axes, body.orientation, body.angular_momentum);
    Quat turn = rotation.at(h) * body.orientation.conjugate();
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
    const double sine = turn.vec().norm(), cosine = turn.w();   // of half the angle
    if (sine == 0.0) return body.angular_velocity;
    // advance_pose() turns by 2 atan(h |omega| / 2) or atan(h |omega|).
    const double length = form == RotationForm::quaternion ? 2.0 * sine / cosine : 2.0 * sine * cosine / (cosine * cosine - sine * sine);
    return length / (h * sine) * turn.vec();
}

}  // namespace

bool turns_too_far(const Body& body, double h) { return h * body.angular_velocity.norm() > tuning::spin_largest_turn; }

Vec3 turning_velocity(const Body& body, double h, RotationForm form, double growth) {
    const Vec3 change = body.inverse_inertia * body.angular_momentum.cross(body.angular_velocity);   // omega'
    const double gain = h * h * change.dot(body.angular_momentum.cross(body.angular_velocity));
    if (!(gain > growth * spin(body)) || turns_too_far(body, h)) return body.angular_velocity;
    return h * body.angular_velocity.norm() < tuning::spin_series_turn ? by_series(body, change, h, form) : in_closed_form(body, h, form);
}

bool spin_grew(const Body& body, double before) { return spin(body) > (1.0 + tuning::spin_growth) * before; }

void limit_spin(Body& body, double before) {
    body.angular_momentum *= std::sqrt(before / spin(body));
    body.derive_velocities();
}

}  // namespace tumble
