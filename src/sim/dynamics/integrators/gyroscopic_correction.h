// Gyroscopic correction: rotation adds no energy to a body. A rotation along one tangent, omega h, with L kept,
// misaligns the body's axes with L, and the energy L.omega / 2 grows, for a needle to many times its value; the next
// impact would turn it into speed.
// With g = omega x L the relative growth is h^2 g.I^-1 g / (L.omega), to leading order (the second derivative of L.I^-1
// L / 2 along the tangent; the first is zero).
// So a step rotates by the mean of the angular velocity over it: always in flight; in contact where the tangent would
// add too much. Where even the mean is too coarse in contact, the energy added by the rotation is removed from L.
#pragma once

#include "sim/dynamics/body.h"

namespace tumble {

/// True if the rotation in a step of h seconds is too large for one tangent: by more than tuning::spin_largest_turn.
bool turns_too_far(const Body& body, double h);

/// The constant angular velocity (rad/s) that, used in advance_pose() over h seconds, gives the orientation of
/// torque-free rotation; omega itself where the rotation is too large.
/// Small rotations by Magnus' series, to third order in h (Magnus 1954): with omega' = -I^-1 g,
///     omega + h omega' / 2 + h^2 omega'' / 6 + h^2 omega' x omega / 12,
/// lengthened to offset the deficit of advance_pose(); larger ones in closed form (free_rotation.h).
Vec3 mean_angular_velocity(const Body& body, double h, RotationForm form);

/// Difference between the mean angular velocity over such a step and omega (rad/s); zero where omega itself adds no
/// more than tuning::spin_steady to the spin, or rotates too far. Contacts constrain the mean: constraining omega would
/// let a top slip by this difference on its tip, or wobble more and more.
Vec3 gyration(const Body& body, double h);
/// Stores gyration() in the body, through a named variable: Eigen copies an unnamed vector in 16-byte moves, which
/// stall on the preceding 8-byte stores.
inline void find_gyration(Body& body, double h) {
    const Vec3 found = gyration(body, h);
    body.gyration = found;
}

/// omega plus the gyroscopic correction, for advance_pose().
Vec3 mean_angular_velocity_in_contact(const Body& body, double h, RotationForm form);

/// Torque-free rotation from an earlier orientation over `duration` (s), in closed form: for rotations too large for
/// one tangent.
void turn_freely(Body& body, const Quat& from, double duration);

/// Twice the rotational energy (J).
inline double spin(const Body& body) { return body.angular_momentum.dot(body.angular_velocity); }

/// True if the rotation has increased spin() from `before` by more than spin_growth of it.
bool spin_grew(const Body& body, double before);

/// Scales L such that spin() equals `before`.
void limit_spin(Body& body, double before);

}  // namespace tumble
