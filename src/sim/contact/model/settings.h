// Constants that both contact solvers share, and those of sleeping.
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

/// Share of the speed that a contact's load gives in a step with which the contact may still approach when the next step
/// begins, because its solver is not exact. Not the whole: the loads under a rigid body on many supports are not unique, and
/// with them as thresholds some of the supports would bounce and others not. Related tests: those of
/// tests/physics/pressed_test.cpp and ManyContacts.FlatBoxOnABedOfBalls.
inline constexpr double load_left = 0.01;

/// Turn of a normal, rad, until two bodies without restitution meet: those that turn more are not stopped at the surface, but
/// meet in an overlap that the impact resolves. Related test: OffCenter.BallsLeaveAlongTheLineOfTheirCenters.
inline constexpr double meeting_turn = 1e-3;

/// Relative accelerations of touching points below this share of their terms are rounding. Not fitted: rounding.
inline constexpr double pressing_rounding = 1e-12;

/// Share of an overlap that is corrected in a step. Smaller values leave boxes sunk after a hard landing; larger
/// ones make heaps tremble (bench_contact). Related: bench_contact "pile of 1000" and the test
/// ContactHardInput.OverlapsDissolveSlowly.
inline constexpr double push_share = 0.2;

/// Largest speed of position correction, radii per second: deep overlaps at the start dissolve in visible time. Not
/// fitted: a choice of appearance. Tests: ContactHardInput.OverlapsDissolveSlowly and
/// SoftKernel.AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved.
inline constexpr double push_limit = 5.0;

/// A curve that passes an edge may overlap it by this share of the smaller radius: tiles may have sunk into their
/// support by as much. A larger overlap is a hit. Related tests: Seam.DoesNotCatchBalls and
/// PredictedGap.ANearMissChangesNothing.
inline constexpr double predicted_gap_overlap = 2e-3;

/// A body is at rest if its surface moved, in one of these spans (s), by less than constant acceleration from rest
/// at `sleep_acceleration` (radii/s^2) gives: 3e-6 radii in the shortest span, 2e-4 in the longest. A block on a
/// slope that is a thousandth steeper than the angle of friction accelerates by 0.01 sin(angle) m/s^2. Related
/// tests: Sleep.NotWhileSlidingOffSlowly and Sleep.OnOrOffChangesNoPlaceByMoreThanATenthOfAMillimeter.
inline constexpr std::array<double, 4> sleep_times = {0.5, 1.0, 2.0, 4.0};
inline constexpr double sleep_acceleration = 2.5e-5;
inline constexpr double sleep_drift(double span) { return 0.5 * sleep_acceleration * span * span; }  // radii

/// Bodies with smaller accelerations are told by their velocity, which is sampled at this interval (s; at least one
/// step). Not fitted: the spans hold a whole number of samples.
inline constexpr double sleep_sample_interval = sleep_times.front() / 16.0;

/// A body accelerates steadily if in this number of samples in a row its velocity grew, or changed in the same
/// direction by at least the share `sleep_steady` of the change before. A body that settles within a second changes
/// by less each time. Two samples would do for heaps: the velocity of a trembling body turns around sooner. Related
/// tests: Sleep.NotWhileRollingOffOrTurningBack and ContactEnergy.HeapsComeToRest.
inline constexpr int sleep_samples = 4;
inline constexpr double sleep_steady = 0.97;

/// A velocity decays if its change loses at least this times the share that the velocity loses: a velocity that goes
/// to 0 as exp(-t/T) has 1, one that turns around has less as it nears 0. Related test: JointRest.ADoorThatTurnsBackStaysAwake.
inline constexpr double sleep_decay = 0.5;

/// Changes of velocity between two samples below this share of g h are rounding of the contact solver. Not fitted:
/// far above double precision, far below a slide. That of joined bodies is tuning::joint_rest.
inline constexpr double sleep_rounding = 1e-10;

}  // namespace tumble::tuning
