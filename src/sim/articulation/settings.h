// Constants of the flight of trees of joined bodies.
#pragma once

namespace tumble::tuning {

/// Error of a step of the extrapolation, as a share of a radian, of the tree's mean radius and of its fastest rate: below,
/// its results are as near to each other as rounding allows. Related test: TreeFlight.ADoublePendulumToTheLastDigits.
inline constexpr double tree_tolerance = 2e-15;

/// Phase, rad, of the first step that is tried: of the fastest turn, of the fastest change of a turn, and of the swing of a
/// link under tension. Not fitted: the error decides.
inline constexpr double tree_phase = 0.5;

/// Largest number of steps in a span. Not fitted: a bound of the cost.
inline constexpr int tree_most_steps = 4096;

/// Gaps up to this share of the smaller body are closed at the start of a step, and speeds that miss the joints by this
/// share of the fastest one are fitted. Not fitted to a case: above rounding, and the energy changes by its square.
inline constexpr double tree_gap = 1e-9;
inline constexpr double tree_misfit = 1e-9;

}  // namespace tumble::tuning
