// The notes' integrators (section 3.2), over one body's state. Both Euler methods are the same two updates, of momenta
// and pose; they differ in the velocities for the pose: explicit Euler takes those of t_n, symplectic Euler those of
// t_n+1.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/math/wrench.h"

namespace tumble {

/// P += h F, L += h tau (notes eq. 7, rows 3 and 4).
void advance_momenta(Body& body, const Vec3& force, const Vec3& torque, double h);

/// P += J, L += the impulse's moment, then derives the velocities.
void advance_momenta(Body& body, const Impulse& impulse);

/// x += h v, and R += h omega* R or q += h/2 omega q, then made a rotation again. `velocity` and `angular_velocity`
/// select the method. The linear update rotates by atan(h|omega|) in matrix form and by 2 atan(h|omega|/2) in
/// quaternion form: the quaternion's angle error is a quarter of the matrix's, (h omega)^3 / 12 against / 3, and it is
/// the cheaper one to bring back to a rotation.
void advance_pose(Body& body, const Vec3& velocity, const Vec3& angular_velocity, double h, RotationForm form);

/// x += h v, and a rotation about the axis of `angular_velocity` by exactly h |omega|.
void turn_exactly(Body& body, const Vec3& velocity, const Vec3& angular_velocity, double h);

/// The rotation nearest to a matrix near one: the polar factor, by Newton's iteration R <- (R + R^-T)/2 (Higham 1986,
/// "Computing the polar decomposition"). Precondition: det > 0, which R + h omega* R always has.
Mat3 nearest_rotation(const Mat3& matrix);

/// The unit quaternion of a rotation matrix (Shepperd 1978), without trigonometric functions.
Quat quaternion_of(const Mat3& rotation);

}  // namespace tumble
