// Constants of the joint solver.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Errors of a locked coordinate below this share of the smaller body are closed by its velocity: they are rounding,
/// and cost no energy. Larger ones are moved out by pseudo-velocities. Not fitted: rounding.
inline constexpr double joint_rounding = 1e-9;

/// The passes of a step end when all locked coordinates are closed to this share of the smaller body. Not fitted:
/// rounding of coordinates a thousand sizes from the origin.
inline constexpr double joint_closed = 1e-13;

/// Largest phase, rad, of a link's swing under tension in a step: the direction of the force is that of the step's
/// start, and the motion grows without bound from a phase of 1 to 2 on. Related test: JointStatics.AWreckingBall.
inline constexpr double joint_phase = 0.7;

/// Phase, rad, below which the next step is tried with half the substeps. Not fitted: half the substeps double it.
inline constexpr double joint_easy_phase = 0.4 * joint_phase;

/// Steps for which the number of substeps stays that the energy of a flight has asked for. Not fitted: longer than a
/// swing, within which the error changes its sign; equal substeps keep the energy in the mean.
inline constexpr int joint_wait = 30;

/// Largest number of substeps: for that phase; where passes do not converge; and where contacts do not. Not fitted:
/// bounds of the cost.
inline constexpr int joint_phase_substeps = 1024;
inline constexpr int joint_open_substeps = 64;
inline constexpr int joint_stuck_substeps = 4;

/// Share of a step within which a rebound from a limit must not end: such a coordinate is held at its limit. Not
/// fitted: it ends a series of bounces by 0.1 / (1 - e) steps too early.
inline constexpr double limit_hop = 0.1;

/// Speed at a limit that is rounding, as a share of the fastest body's; times of impacts on limits that are one, as a
/// share of the step; and impacts in a step by rows, after which limits have no restitution. Not fitted: rounding; a
/// bound of the cost.
inline constexpr double limit_rest = 1e-12;
inline constexpr double limit_together = 1e-9;
inline constexpr int limit_cuts = 16;

/// Largest phase, rad, of a spring in a step of flight: the error of a kick is a 24th of its square. Stiffer springs
/// are implicit. Not fitted: a tenth of a swing.
inline constexpr double joint_flight_spring = 0.6;

/// Most closure rows of a group: their matrix is dense, and each is a sweep over the tree. Limits the cost.
inline constexpr int tree_most_closures = 64;

/// Largest error of a flight, in sizes of the joint: of a mechanism that passes a singular position. Related test:
/// JointReference.AFourBarPassesItsSingularPosition.
inline constexpr double joint_flight_open = 1e-5;

/// Share of its strength that a joint may carry in the step of a flight in which it breaks. Above, the step is solved
/// such that it carries no more than its strength. Not fitted: the load of a free motion changes little in a step.
inline constexpr double joint_flight_over = 1.1;

/// Factor of the tolerance of Newton's steps for joints in contact, and their number: in the first and each later
/// round, and in the trial with stiff friction. Not fitted: cost.
inline constexpr double joint_contact_tolerance = 100.0;
inline constexpr int joint_first_newton_steps = 100;
inline constexpr int joint_newton_steps = 40;
inline constexpr int joint_trial_newton_steps = 12;

/// Change of the velocities in a round, as a share of the change in the step, at which the impulses of bodies that come
/// to rest count as settled, and the convergence of the rounds there, relative to the impulses: looser ones leave
/// a creep that never ends, or let jammed bodies tremble. Related test: JointRest.AJammedFigureFallsAsleep.
inline constexpr double joint_rest = 1e-8;
inline constexpr double joint_rest_tolerance = 1e-6;

/// Rounds of a step of an island with joints. Not fitted: a bound of the cost.
inline constexpr int joint_rounds = 40;

/// Share of a joint's error that is moved out in a step. Test: JointLaws.AnAnchorApartIsPulledInWithoutSpeed.
inline constexpr double joint_correction_share = 0.2;

/// Bodies of figures that touch something from which on all of them are solved in sweeps, the number down to which that
/// stays so, and the steps after which it ends. Limits the cost: three ragdolls of 15 bodies are solved by rows.
inline constexpr std::size_t figures_swept = 48;
inline constexpr std::size_t figures_kept = 36;
inline constexpr int figure_wait = 30;

}  // namespace tumble::tuning
