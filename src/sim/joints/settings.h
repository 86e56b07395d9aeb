// Constants of the joint solver.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Compliance of rigid rows, over the island's mass and its number of joints. A round makes the error of a chain about a
/// thousand times smaller, at any length, because the softest motion of n links has a compliance of pi^2 / n over
/// their mass. Smaller values add rounding to the impulses.
inline constexpr double joint_compliance = 1e-2;

/// Factor of that compliance where two passes in a row leave more than half of the error. Not fitted: a pass then leaves a
/// hundredth, and the impulses lose two more digits.
inline constexpr double joint_stiffer = 1e-2;

/// Errors of a locked coordinate below this share of the smaller body are closed by its velocity: they are rounding,
/// and cost no energy. Larger ones are moved out by pseudo-velocities. Not fitted: rounding.
inline constexpr double joint_rounding = 1e-9;

/// The passes of a step end when all locked coordinates are closed to this share of the smaller body. Not fitted:
/// rounding of coordinates a thousand sizes from the origin.
inline constexpr double joint_closed = 1e-13;

/// Residual of Newton's steps, as a share of the fastest speed, that may be rounding: the stiffness of rigid rows times
/// the rounding of speeds. Not fitted: rounding.
inline constexpr double joint_stall = 1e-9;

/// Largest phase, rad, of a link's swing under tension in a step: the direction of the force is that of the step's start,
/// and the motion grows without bound from a phase of 1 to 2 on. Related test: JointStatics.AWreckingBall.
inline constexpr double joint_swing = 0.7;

/// Phase, rad, below which the next step is tried with half the substeps. Not fitted: half the substeps double it.
inline constexpr double joint_easy_swing = 0.4 * joint_swing;

/// Steps for which the number of substeps stays that the energy of a flight has asked for. Not fitted: longer than a swing,
/// within which the error changes its sign; equal substeps keep the energy in the mean.
inline constexpr int joint_wait = 30;

/// Largest number of substeps: for that phase; where passes do not converge; and where contacts do not. Not fitted:
/// bounds of the cost.
inline constexpr int joint_swing_substeps = 1024;
inline constexpr int joint_open_substeps = 64;
inline constexpr int joint_stuck_substeps = 4;

/// Stiffness of joints in the position correction, over the mean mass of the bodies, where an error is moved out. Near
/// a singular position, as of a taut chain, it is closed by displacements up to half the square root of this times as
/// large.
inline constexpr double joint_push_apart = 1e3;

/// Stiffness of closed joints there, over the mass of the island: a hundred times that of contacts, so that each pass
/// makes their errors up to a hundred times smaller.
inline constexpr double joint_push_closed = 1e4;

/// Errors below this share of the smaller body are moved out by rigid rows: the displacements stay small near singular
/// positions too. Not fitted: below any visible size.
inline constexpr double joint_push_small = 1e-6;

/// Convergence of the rounds without contacts, relative to the impulses. Related test:
/// JointLaws.AMotorOpensADoorToItsLimit.
inline constexpr double joint_round_tolerance = 1e-8;

/// The velocities fit the joints to this share of the fastest one at the end of a step by rows. Not fitted: rounding.
inline constexpr double joint_fits = 1e-14;

/// Share of its bound up to which a motor or dry friction counts as holding its speed at the end of a step: the bound of
/// friction follows the loads, and the impulse of a slipping joint is not quite at it. Not fitted.
inline constexpr double joint_fit_below = 0.999;

/// Share of a step within which a rebound from a limit must not end: such a coordinate is held at its limit. Not fitted: it
/// ends a series of bounces by 0.1 / (1 - e) steps too early.
inline constexpr double limit_hop = 0.1;

/// Speed at a limit that is rounding, as a share of the fastest body's; times of impacts on limits that are one, as a share of
/// the step; and impacts in a step by rows, after which limits have no restitution. Not fitted: rounding; a bound of the cost.
inline constexpr double limit_rest = 1e-12;
inline constexpr double limit_together = 1e-9;
inline constexpr int limit_cuts = 16;

/// Largest phase, rad, of a spring in a step of flight: the error of a kick is a 24th of its square. Stiffer springs are
/// implicit. Not fitted: a tenth of a swing.
inline constexpr double joint_flight_spring = 0.6;

/// Largest rate of a damper times the step in a flight by Verlet's method: speeds that fall faster would change their sign.
inline constexpr double joint_flight_damper = 2.0;

/// Most closure rows of a group: their matrix is dense, and each is a sweep over the tree. Limits the cost.
inline constexpr int tree_most_closures = 64;

/// Largest error of a flight, in sizes of the joint: of a mechanism that passes a singular position. Related test:
/// JointReference.AFourBarPassesItsSingularPosition.
inline constexpr double joint_flight_open = 1e-5;

/// Passes after which such a position ends them. Not fitted: others contract by 10 in each.
inline constexpr int joint_singular_rounds = 8;

/// Largest error, in sizes of the joint, that is closed where CCD stops joined bodies within the step. Not fitted: bodies
/// that turn by a radian in a step open their joints by less.
inline constexpr double joint_clamped_open = 0.1;

/// Rounds of a solve for these displacements. Not fitted: two more passes would do the same.
inline constexpr int joint_close_rounds = 3;

/// Share of its strength that a joint may carry in the step of a flight in which it breaks. Above, the step is solved such
/// that it carries no more than its strength. Not fitted: the load of a free motion changes little in a step.
inline constexpr double joint_flight_over = 1.1;

/// Compliance of a flight's rows over that of a body, in units of the fourth power of the largest relative turn in the
/// stage: four-bars that lie flat twice a turn pass from 0.1 on. Related test: JointReference.AFourBarPassesItsSingularPosition.
inline constexpr double joint_singular = 0.2;

/// Factor of the tolerance of Newton's steps for joints in contact, and their number: in the first and each later round,
/// and in the trial with stiff friction. Not fitted: cost.
inline constexpr double joint_contact_tolerance = 100.0;
inline constexpr int joint_first_newton_steps = 100;
inline constexpr int joint_newton_steps = 40;
inline constexpr int joint_trial_newton_steps = 12;

/// Error, in sizes of the joint, at which the joints of an island in contact count as closed after
/// tuning::direct_rounds rounds, and once the impulses have settled; and error of a gap at the end of the step, in sizes
/// of the contact, once they have settled. Not fitted: the next step closes the rest.
inline constexpr double joint_contact_closed = 1e-7;
inline constexpr double joint_contact_settled = 1e-8;
inline constexpr double joint_corner_closed = 1e-5;

/// Least turn, rad, of a body in a step in which the gaps of corners are closed: the rest of the gap is half its square, in
/// sizes of the contact. Not fitted: less is invisible.
inline constexpr double joint_corner_turn = 0.005;

/// Change of the velocities in a round, as a share of the change in the step, at which the impulses in contact count as
/// settled. Not fitted: larger ones let resting bodies creep.
inline constexpr double joint_contact_rest = 1e-6;

/// The same where bodies come to rest, and the convergence of the rounds there, relative to the impulses: looser ones leave
/// a creep that never ends, or let jammed bodies tremble. Related test: JointRest.AJammedFigureFallsAsleep.
inline constexpr double joint_rest = 1e-8;
inline constexpr double joint_rest_tolerance = 1e-6;

/// Rounds of a step of an island with joints. Not fitted: a bound of the cost.
inline constexpr int joint_rounds = 40;

/// Share of a joint's error that is moved out in a step. Test: JointLaws.AnAnchorApartIsPulledInWithoutSpeed.
inline constexpr double joint_push_share = 0.2;

/// Nets are groups with more joints than bodies, of at least so many bodies and more block products per body in a
/// factorization, or with ropes (distance joints with limits), whose changes between taut and slack need dozens of
/// factorizations in a step. Limits the cost.
inline constexpr std::size_t net_bodies = 256;
inline constexpr double net_work = 100.0;
inline constexpr std::size_t net_bodies_of_ropes = 64;

/// Bodies of figures that touch something from which on all of them are solved in sweeps, the number down to which that
/// stays so, and the steps after which it ends. Limits the cost: three ragdolls of 15 bodies are solved by rows.
inline constexpr std::size_t figures_swept = 48;
inline constexpr std::size_t figures_kept = 36;
inline constexpr int figure_wait = 30;

/// Largest number of bodies of a figure. Not fitted: sweeps carry a blow along a few joints in a substep, not along a chain
/// of a hundred.
inline constexpr std::size_t figure_most = 64;

/// Largest compliance at an anchor by a body's turns over that by its mass, for joints that lock or limit turns and for others:
/// sweeps lose its square, and itself, of the digits of single precision. Not fitted: a hundredth of the digits is left.
inline constexpr double turn_leverage = 300.0;
inline constexpr double point_leverage = 1e4;

/// Largest ratio of the masses that a joint of a net or figure connects: sweeps stretch joints that hold a heavy body by light
/// ones. Not fitted: far from such loads.
inline constexpr double net_mass_ratio = 16.0;

}  // namespace tumble::tuning
