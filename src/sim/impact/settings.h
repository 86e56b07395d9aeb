// Constants of impacts: restitution, the active-set solver, impact laws and friction.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Approach speeds below this times |g| h, or times the load speed of the contact (load_speed()), do not bounce. Gravity
/// gives a resting contact g h in each step, its load the load speed; twice that is distinct from it. Not fitted. Tests:
/// tests/sim/contact_scenes.h, tests/physics/pressed_test.cpp.
inline constexpr double restitution_threshold = 2.0;

/// With time-stepped impacts, a bounce that would separate slower than this times |g| h, or times the load speed, does not
/// happen either: the hop would last two steps, and the body would stay in an overlap and be lifted out of it. Related test:
/// ContactEnergy.ABodyThatHardlyBouncesLandsAtTheSurface.
inline constexpr double restitution_rebound = 1.0;

/// Contacts of an impact that are solved together exactly. The cost grows with the cube of the contacts: 1 ms at
/// 100, 30 ms at 256, 0.3 s at 512. Sweeps, which take over beyond, stop short of the solution in long chains.
/// Limits the cost.
inline constexpr std::size_t projection_contacts = 512;

/// The same number in the passes of a propagating impact. Sweeps are faster from fewer contacts on (heaps of 216
/// bouncing boxes: half the time of 256), and a pass need not be exact: it conserves the energy in any case. Tests:
/// Large.SweepsKeepTheEnergy and Large.RackKeepsItsMirrorImage.
inline constexpr std::size_t pass_contacts = 64;

/// Approaches below this share of the restitution threshold, a quarter of gravity's g h, take no part in impacts of
/// more contacts than that. In a heap a sixth of the approaching contacts is left, in small groups that are solved
/// exactly. Related test: ContactEnergy.BouncesInAHeapPushNoBodyAlong.
inline constexpr double impact_slow = 0.125;

/// A unit row is linearly dependent on others if less than this is left of it: mass ratios of 1 : 1e8 in one
/// contact leave 1e-4. Not fitted. Related test: HardInput.MassesOfOneToAHundredMillion.
inline constexpr double projection_dependent = 1e-8;

/// Impulses are distributed over contacts whose rows are dependent to the first value (rounding of lever arms of
/// some hundred meters), or clearly independent by the second. In between, rounding would decide the distribution.
/// Related test: ActiveSet.SpreadsOverDependentRows.
inline constexpr double projection_spread_dependent = 1e-12;
inline constexpr double projection_spread_independent = 1e-3;

/// Most rows over which impulses are distributed with the least sum of squares among those that only push, with the most
/// Newton steps, the relative error of their sum, and the least second derivative. Beyond, the distribution stops short
/// of that. Limits the cost; not fitted: rounding.
inline constexpr std::size_t projection_even_rows = 128;
inline constexpr int projection_even_steps = 30;
inline constexpr double projection_even_rounding = 1e-14;
inline constexpr double projection_even_least = 1e-10;

/// A row whose multiplier falls slower than this, relative to the rising one, does not block it: rounding. Not
/// fitted: rounding.
inline constexpr double projection_weight = 1e-13;

/// Sweeps of projected Gauss-Seidel, and the relative change at which it has converged. Related test:
/// ActiveSet.SweepsApproximateTheExactSolution.
inline constexpr int projection_sweeps = 400;
inline constexpr double projection_sweep_tolerance = 1e-14;

/// Approach speeds below this share of the largest relative speed of the impact system are rounding,
inline constexpr double approach_relative = 1e-13;

/// and those below this share of its largest speed. Not fitted: some ten units of rounding.
inline constexpr double approach_rounding = 4e-15;

/// An impulse counts, for friction and as a bounce, if it changes v_rel by more than this many times the rounding of speeds:
/// 1e-9 of the fastest approach. Not fitted: far above the rounding of positions and normals. Related test:
/// Rack.BouncesAsItsMirrorImage.
inline constexpr double impact_felt = 1e4;

/// Compliance of a joint's locked coordinates at an impact, of unit forms: square root of the rounding of double
/// precision, where a pass removes all but a share of 1e-8 of an error for the least of the two causes, rounding and the
/// compliance over the squared singular value (1e-2 for ragdolls, 1e-5 for a chain of a thousand links, 1e-8 for
/// masses of 1 : 1e8). Not fitted: rounding.
inline constexpr double impact_lock_compliance = 1e-8;

/// Share of the first error at which the passes end, and the most passes. Not fitted: rounding, and a bound of the cost.
inline constexpr double impact_lock_rounding = 1e-16;
inline constexpr int impact_lock_passes = 60;

/// Largest number of products of an impact of joined bodies, contacts squared times the numbers of a group: about 30 ms.
/// Beyond, the solver of contacts bounces them. Limits the cost.
inline constexpr double impact_joined_work = 3e7;

/// Passes of a propagating impact, per contact. Most impacts end within three. More are needed for a light ball
/// between a heavy one and a wall (31415 for masses of 1 : 1e8): their number is proportional to the inverse margin
/// of the contacts. Sets without a margin are jammed. Related tests: HardInput.LightBallBetweenAHeavyOneAndAWall
/// and Galperin.EndsAsInTheUnfoldedWedge.
inline constexpr int impact_passes_each = 3;
inline constexpr int impact_passes_more = 10;
inline constexpr double impact_passes_margin = 4.0;
inline constexpr int impact_passes_limit = 100000;

/// Bodies between moving walls leave at most at this many times the speed of the walls: a wedge of about 20
/// degrees. Related test: Restitution.InAnAcuteCornerGainsNothing.
inline constexpr double impact_wedge = 3.0;

/// Contacts with a margin below the inverse of this are jammed where walls move: the two sides of a box in a press.
/// Related test: Kinematic.PushesTheHeavyThroughTheLight.
inline constexpr double impact_deepest = 100.0;

/// Largest sum over the passes of the squared number of contacts: about 50 ms. Longer impacts are slow inelastic
/// approaches of many contacts to one common speed. Not fitted: a bound of the cost.
inline constexpr double impact_work = 3e5;

/// Elastic passes end by themselves; they count by this share. Limits the cost.
inline constexpr double impact_elastic_work = 0.1;

/// Rounds of friction with restitution for the contacts that friction makes approach again, and rounds in all. Not
/// fitted: bounds of the cost.
inline constexpr int friction_bounces = 4;
inline constexpr int friction_rounds = 12;

/// Sweeps of friction over an impact system. Not fitted: a bound of the cost.
inline constexpr int friction_sweeps = 400;

/// Relaxations of contacts in a large system in all, with this least number of sweeps. Each sweep lowers the energy, so
/// any may be the last. Not fitted: bounds of the cost.
inline constexpr int friction_work = 400;
inline constexpr int friction_least_sweeps = 2;

/// Change of speed, relative to the slip, at which friction has converged: between steps, and at a step, whose own
/// error is larger. Not fitted.
inline constexpr double friction_tolerance = 1e-14;
inline constexpr double friction_tolerance_step = 1e-5;

/// Contacts with friction up to which that tolerance holds, and the tolerance for more. Limits the cost.
inline constexpr std::size_t friction_few = 8;
inline constexpr double friction_tolerance_many = 1e-6;

/// Contacts of an impact up to which those with friction are relaxed at once, so that no order shows: a rack of 15 balls has
/// 47. Beyond, one after the other takes fewer sweeps. Limits the cost. Related test: Rack.BouncesAsItsMirrorImage.
inline constexpr std::size_t friction_at_once = 128;

/// Sweeps at once in which friction's limits follow the normal impulses. Not fitted: most impacts need fewer.
inline constexpr int friction_follow = 100;

/// Newton steps to the edge of a friction disc. The method converges quadratically: 4 to 8 are enough for any
/// compliance. Not fitted: a bound of the cost.
inline constexpr int friction_newton = 50;

}  // namespace tumble::tuning
