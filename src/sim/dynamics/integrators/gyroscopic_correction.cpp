#include "sim/dynamics/integrators/gyroscopic_correction.h"

#include "core/deterministic_math.h"
#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/dynamics/settings.h"
#include "sim/math/free_rotation.h"
#include "sim/math/keyframe_track.h"

#include <cmath>

namespace tumble {
namespace {

/// The limit of tuning::spin_steady for bodies in contact. Related test: ContactEnergy.FastTumblingPlanksGainNothing.
constexpr double spin_growth = 0.01;

// Longer by tan(x) / x, with half the angle for quaternions: advance_pose() rotates by the angle's tangent.
Vec3 lengthened(const Vec3& omega, double h, RotationForm form) {
    const double length = form == RotationForm::quaternion ? 0.5 * h : h,
                 square = length * length * omega.squaredNorm();
    if (square < tuning::spin_series_turn * tuning::spin_series_turn)
        return (1.0 +
                square * (1.0 / 3.0 +
                          square * (2.0 / 15.0 + square * (17.0 / 315.0 +
                                                           square * (62.0 / 2835.0 + square * (1382.0 / 155925.0)))))) *
               omega;
    const double x = std::sqrt(square);
    const auto [sine, cosine] = sincos(x);
    return sine / (cosine * x) * omega;
}

Vec3 by_series(const Body& body, double h) {
    const Vec3 &omega = body.angular_velocity, &l = body.angular_momentum;
    const Vec3 change = body.inverse_inertia * l.cross(omega);  // omega'
    // I^-1 rotates with the body: (I^-1)' = omega* I^-1 - I^-1 omega*.
    const Vec3 second = omega.cross(change) - body.inverse_inertia * (omega.cross(l.cross(omega))) +
                        body.inverse_inertia * l.cross(change);
    return omega + 0.5 * h * change + h * h / 6.0 * second + h * h / 12.0 * change.cross(omega);
}

Vec3 in_closed_form(const Body& body, double h) {
    const FreeRotation rotation(body.principal_inertia, body.principal_axes, body.orientation, body.angular_momentum);
    return rotation_vector(rotation.at(h) * body.orientation.conjugate()) / h;
}

// Mean angular velocity of torque-free rotation over the step.
Vec3 mean(const Body& body, double h) {
    return h * body.angular_velocity.norm() < tuning::spin_series_turn ? by_series(body, h) : in_closed_form(body, h);
}

}  // namespace

bool turns_too_far(const Body& body, double h) {
    return h * h * body.angular_velocity.squaredNorm() > tuning::spin_largest_turn * tuning::spin_largest_turn;
}

Vec3 mean_angular_velocity(const Body& body, double h, RotationForm form) {
    return turns_too_far(body, h) ? body.angular_velocity : lengthened(mean(body, h), h, form);
}

Vec3 gyration(const Body& body, double h) {
    if (body.spherical_top) return Vec3::Zero();
    const Vec3 g = body.angular_velocity.cross(body.angular_momentum);
    if (!(h * h * g.dot(body.inverse_inertia * g) > tuning::spin_steady * spin(body)) || turns_too_far(body, h))
        return Vec3::Zero();
    return mean(body, h) - body.angular_velocity;
}

Vec3 mean_angular_velocity_in_contact(const Body& body, double h, RotationForm form) {
    return turns_too_far(body, h) ? body.angular_velocity
                                  : lengthened(body.angular_velocity + gyration(body, h), h, form);
}

bool spin_grew(const Body& body, double before) { return spin(body) > (1.0 + spin_growth) * before; }

void limit_spin(Body& body, double before) {
    body.angular_momentum *= std::sqrt(before / spin(body));
    body.derive_velocities();
}

void turn_freely(Body& body, const Quat& from, double duration) {
    const RigidMass mass = mass_of(body);
    RigidState state = state_of(body);
    state.orientation =
        FreeRotation(mass.principal_inertia, mass.principal_axes, from, body.angular_momentum).at(duration);
    set_state(body, state);
}

}  // namespace tumble
