// Constants of the flight of trees of joined bodies.
#pragma once

namespace tumble::tuning {

/// Phase, rad, of the first step that is tried: of the fastest turn, of the fastest change of a turn, and of the swing
/// of a link under tension. Not fitted: the error decides.
inline constexpr double tree_phase = 0.5;

/// Largest number of such steps in a span, and the number of parts of one in which the error must be reached: otherwise
/// the rows advance the bodies. Not fitted: bounds of the cost.
inline constexpr int tree_most_steps = 1024;
inline constexpr int tree_few_steps = 8;  // of a step with the default integrator
inline constexpr int tree_shortest = 16;

/// Gaps up to this share of the smaller body are closed at the start of a step, and speeds that miss the joints by this
/// share of the fastest one are fitted. Not fitted to a case: above rounding, and the energy changes by its square.
inline constexpr double tree_gap = 1e-9;
inline constexpr double tree_misfit = 1e-9;

/// Speed below which a coordinate with friction is at rest, as a share of the fastest body's: rounding of the momenta.
/// Not fitted.
inline constexpr double friction_rest = 1e-12;

/// Effort above the bound of friction, as a share of it, at which a held coordinate is let go: it then leaves with an
/// acceleration that is not rounding. Not fitted: far below the tolerances of the tests.
inline constexpr double friction_let_go = 1e-10;

/// Excess at a change of friction or at a break, in its unit, which is rounding; and the number of changes in a step,
/// and of trials for one of them, beyond which the rows advance the bodies. Not fitted: bounds of the cost.
inline constexpr double tree_event_located = 1e-14;
inline constexpr int tree_most_events = 64;
inline constexpr int tree_most_trials = 60;

/// Gap, in sizes of the joint, at which cut joints are closed; and passes in which that is reached. Not fitted:
/// rounding; a bound of the cost.
inline constexpr double closure_closed = 8e-15;
inline constexpr int closure_passes = 40;

/// Rest of a step after a break, as a share of the step, that is left out. Not fitted: rounding of the positions.
inline constexpr double tree_least_rest = 1e-12;

/// Rotation, rad, of the fastest body in a part of a flight past other bodies; the most parts of a step; and searches
/// in a part after which the bodies count as met. Not fitted: the paths between the parts are cubic, with an error of
/// 2e-4 of the body's radius in half a radian; the others are bounds of the cost.
inline constexpr double flight_turn = 0.5;
inline constexpr double flight_most_parts = 64.0;
inline constexpr int flight_searches = 8;

}  // namespace tumble::tuning
