// Constants that both contact solvers share, and constants of sleeping.
#pragma once

#include <array>

namespace tumble::tuning {

/// Substep of the soft contact solver, s. Eight substeps in a step of 1/60 s hold a heap of a thousand boxes with
/// overlaps below a thousandth of their size (bench_contact "pile of 1000"). Overlaps grow with its square, so
/// short steps are divided too. Related: bench_contact "pile of 1000".
inline constexpr double soft_substep = 1.0 / 480.0;

/// Friction acts at the centroid of the contact points at gaps below `friction_near` (share of the smaller radius).
/// Farther points have the weight `friction_far_weight`. Related test:
/// SoftKernel.FrictionActsAtTheCentroidOfTheArea.
inline constexpr double friction_near = 2e-3;
inline constexpr double friction_far_weight = 0.01;

/// Torsional friction shares the friction limit of a contact where the contact area's slip from spin, at its mean
/// distance, exceeds this share of the total slip. Below, all torsional friction is available to stop a spin:
/// otherwise friction at a single point, beside an uneven load, would turn a sliding body. Related test:
/// SpinFriction.AHeavyEndSlidesStraight.
inline constexpr double spin_share = 0.2;

/// Share of the speed that a contact's load gives in a step with which the contact may still approach when the next
/// step begins, because its solver is not exact. Not the whole: the loads under a rigid body on many supports are not
/// unique, and with them as thresholds some of the supports would bounce and others not. Related tests: those of
/// tests/physics/pressed_test.cpp and ManyContacts.FlatBoxOnABedOfBalls.
inline constexpr double load_left = 0.01;

/// Largest speed of position correction, radii per second: deep overlaps at the start dissolve in visible time. Not
/// fitted: a choice of appearance. Tests: ContactHardInput.OverlapsDissolveSlowly and
/// SoftKernel.AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved.
inline constexpr double correction_limit = 5.0;

/// A body is at rest if its surface moved, in one of these spans (s), by less than constant acceleration from rest
/// at `sleep_acceleration` (radii/s^2) gives: 3e-6 radii in the shortest span, 2e-4 in the longest. A block on a
/// slope that is a thousandth steeper than the angle of friction accelerates by 0.01 sin(angle) m/s^2. Related
/// tests: Sleep.NotWhileSlidingOffSlowly and Sleep.OnOrOffChangesNoPlaceByMoreThanATenthOfAMillimeter.
inline constexpr std::array<double, 4> sleep_times = {0.5, 1.0, 2.0, 4.0};
inline constexpr double sleep_acceleration = 2.5e-5;
inline constexpr double sleep_drift(double span) { return 0.5 * sleep_acceleration * span * span; }  // radii

}  // namespace tumble::tuning
