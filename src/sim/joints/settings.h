// Constants of the joint solver.
#pragma once

namespace tumble::tuning {

/// Compliance of rigid rows, over the island's mass and its number of joints. A round makes the error of a chain about a
/// thousand times smaller, whatever its length, because the softest motion of n links has a compliance of pi^2 / n over
/// their mass. Smaller values add rounding to the impulses.
inline constexpr double joint_compliance = 1e-2;

/// Errors of a locked coordinate below this share of the smaller body are closed by its velocity: they are rounding,
/// and cost no energy. Larger ones are moved out by pseudo-velocities. Not fitted: rounding.
inline constexpr double joint_rounding = 1e-9;

/// The passes of a step end when all locked coordinates are closed to this share of the smaller body. Not fitted:
/// rounding of coordinates a thousand sizes from the origin.
inline constexpr double joint_closed = 1e-13;

/// Residual of Newton's steps, as a share of the fastest speed, that may be rounding: the stiffness of rigid rows times
/// the rounding of speeds. Not fitted: rounding.
inline constexpr double joint_stall = 1e-6;

/// Rounds of a step of an island with joints. Not fitted: a bound of the cost.
inline constexpr int joint_rounds = 40;

/// Share of a joint's error that is moved out in a step. Test: Joints.AnAnchorApartIsPulledInWithoutSpeed.
inline constexpr double joint_push_share = 0.2;

}  // namespace tumble::tuning
