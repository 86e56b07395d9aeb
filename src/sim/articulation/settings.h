// Constants of the flight of trees of joined bodies.
#pragma once

namespace tumble::tuning {

/// Error of a step of the extrapolation, as a share of a radian, of the tree's mean radius and of its fastest rate: below,
/// its results are as near to each other as rounding allows. Related test: TreeFlight.ADoublePendulumToTheLastDigits.
inline constexpr double tree_tolerance = 2e-15;

/// Error in units of that tolerance which may be rounding. Related test: TreeFlight.LightLinksBetweenHeavyBodies.
inline constexpr double tree_rounding = 1e5;

/// Phase, rad, of the first step that is tried: of the fastest turn, of the fastest change of a turn, and of the swing of a
/// link under tension. Not fitted: the error decides.
inline constexpr double tree_phase = 0.5;

/// Largest number of such steps in a span, and the number of parts of one in which the error must be reached: else the
/// rows advance the bodies. Not fitted: bounds of the cost.
inline constexpr int tree_most_steps = 1024;
inline constexpr int tree_few_steps = 8;  // of a step with the default integrator
inline constexpr int tree_shortest = 16;

/// Gaps up to this share of the smaller body are closed at the start of a step, and speeds that miss the joints by this
/// share of the fastest one are fitted. Not fitted to a case: above rounding, and the energy changes by its square.
inline constexpr double tree_gap = 1e-9;
inline constexpr double tree_misfit = 1e-9;

/// Change of the speeds at the end of a stage of Verlet's method that ends its passes, as a share of the fastest one: of second
/// order, and in compositions. Related test:
/// Verlet.OrdersWithBallsAndFreeTrees; and rounding.
inline constexpr double verlet_tolerance = 1e-8;
inline constexpr double verlet_rounding = 1e-15;

/// Error of the energy in a step of Verlet's method, as a share of the kinetic energy, above which the substeps are halved.
/// Related test: Verlet.FastFreeTreesKeepTheirEnergy.
inline constexpr double verlet_energy = 1e-4;

/// Share of the last change above which a pass does not converge, and the change that is then rounding. Not fitted.
inline constexpr double verlet_contraction = 0.5;
inline constexpr double verlet_stall = 1e-11;

/// Passes beyond which the next step is tried with no fewer substeps. Not fitted: the number changes the cost alone.
inline constexpr int verlet_easy_passes = 10;

/// Speed below which a coordinate with friction is at rest, as a share of the fastest body's: rounding of the momenta. Not fitted.
inline constexpr double friction_rest = 1e-12;

/// Effort above the bound of friction, as a share of it, at which a held coordinate is let go: it then leaves with an
/// acceleration that is not rounding. Not fitted: far below the tolerances of the tests.
inline constexpr double friction_let_go = 1e-10;

/// Excess at a change of friction or at a break, in its unit, which is rounding; and the number of changes in a step, and
/// of trials for one of them, beyond which the rows advance the bodies. Not fitted: bounds of the cost.
inline constexpr double tree_event_located = 1e-14;
inline constexpr int tree_most_events = 64;
inline constexpr int tree_most_trials = 60;

/// Share of its compliance below which a row is redundant; and compliance added to all, as a share of the largest, whose
/// error refinement removes. Not fitted: between rounding and the ratio of masses.
inline constexpr double closure_redundant = 1e-10;
inline constexpr double closure_compliance = 1e-12;

/// Gap, in sizes of the joint, at which cut joints are closed; and passes in which that is reached. Not fitted: rounding; a
/// bound of the cost.
inline constexpr double closure_closed = 8e-15;
inline constexpr int closure_passes = 40;

/// Largest energy of the impulses at one end of a stage, as a share of the kinetic one: in singular positions they would be
/// blows, where a mechanism can move to first order alone. Not fitted: of fourth order in the step elsewhere.
inline constexpr double closure_energy = 0.01;

/// Substeps beyond which passes that do not close the joints leave the step to the rows. Not fitted: a bound of the cost.
inline constexpr int closure_substeps = 64;

/// Angle, rad, that a ball may be beyond its limit; and the turn, rad, over which the rate of the limit's direction is found.
/// Not fitted: rounding of the angles, and of their differences.
inline constexpr double limit_of_ball = 1e-12;
inline constexpr double limit_difference = 1e-3;

/// Load over strength of a joint at both ends of a part of a step, above which its largest load between them is looked for.
/// Not fitted: a part is half a radian of the motion.
inline constexpr double tree_near_break = 0.8;

/// Rest of a step after a break, as a share of the step, that is left out. Not fitted: rounding of the places.
inline constexpr double tree_least_rest = 1e-12;

/// Rotation, rad, of the fastest body in a part of a flight past other bodies; the most parts of a step; and searches in
/// a part after which the bodies count as met. Not fitted: the paths between the parts are cubic, with an error of
/// 2e-4 of the body's radius in half a radian; the others are bounds of the cost.
inline constexpr double flight_turn = 0.5;
inline constexpr double flight_most_parts = 64.0;
inline constexpr int flight_searches = 8;

}  // namespace tumble::tuning
