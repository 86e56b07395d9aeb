// No turn adds energy to a body. Turned by one tangent, omega h, with L kept, the body's axes would lie a little wrong to L, and
// the energy L.omega / 2 would grow, of a needle to many times what it was; the next impact would make speed of that. With
// g = omega x L the growth is h^2 g.I^-1 g / (L.omega) of it, to leading order (the second derivative of L.I^-1 L / 2 along the
// tangent; the first is zero). So a step turns by the mean of the angular velocity over it: always in flight, where the tangent
// would add too much in contact. Where even that is too coarse in contact, what the turn has added is taken out of L.
#pragma once

#include "sim/dynamics/body.h"

namespace tumble {

/// Whether the body turns farther in a step of h seconds than one tangent can stand for: by more than tuning::spin_largest_turn.
bool turns_too_far(const Body& body, double h);

/// The constant angular velocity (rad/s) that takes the body in a step of h seconds to where torque-free rotation takes it, for
/// advance_pose(); omega itself where it turns too far.
/// Small turns by Magnus' series, to third order in h (Magnus 1954): with omega' = -I^-1 g,
///     omega + h omega' / 2 + h^2 omega'' / 6 + h^2 omega' x omega / 12,
/// longer by what advance_pose() turns too little; larger ones in closed form (free_rotation.h).
Vec3 mean_angular_velocity(const Body& body, double h, RotationForm form);

/// By how much the mean of the angular velocity over such a step differs from omega (rad/s); nothing where omega as it stands adds
/// no more than tuning::spin_steady to the spin, or turns too far. What contact holds in a step is held for the mean: held for
/// omega, a top would slip by as much on its tip, or wobble more and more.
Vec3 gyration(const Body& body, double h);
/// Into the body. By way of a name: Eigen moves an unnamed vector by sixteen bytes, which wait for those just written by eight.
inline void find_gyration(Body& body, double h) {
    const Vec3 found = gyration(body, h);
    body.gyration = found;
}

/// omega and its gyration, for advance_pose().
Vec3 mean_angular_velocity_in_contact(const Body& body, double h, RotationForm form);

/// Torque-free rotation from an earlier orientation over `duration` (s), in closed form: for turns too large for one tangent.
void turn_freely(Body& body, const Quat& from, double duration);

/// Twice the energy of its spin (J).
inline double spin(const Body& body) { return body.angular_momentum.dot(body.angular_velocity); }

/// Whether the spin has grown from what it was before the body turned, by more than tuning::spin_growth of it.
bool spin_grew(const Body& body, double before);

/// Scales L so that the spin is what it was.
void limit_spin(Body& body, double before);

}  // namespace tumble
