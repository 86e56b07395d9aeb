// Constants of contact geometry: tolerances of shapes and manifolds.
#pragma once

namespace tumble::tuning {

/// Two surfaces touch at gaps below this share of the smaller body's radius: far above rounding, far below visible
/// size. Not fitted. Tests: tests/sim/detection/narrow_phase_test.cpp and landing_test.cpp.
inline constexpr double touch = 1e-6;

/// Two edges nearer to parallel than this (squared sine of their angle) give no separating axis; a face normal
/// covers the case. Related test: ContactHardInput.ParallelAndCrossingEdges.
inline constexpr double parallel_edges = 1e-8;

/// Turn of a body in a step, rad, above which several corners of a cylinder of 200 corners may reach the other
/// surface in the step. Related test: Rolling.WheelsOfCornersStayOnTheGround.
inline constexpr double fast_rotation_turn = 0.03;

/// A point that the reduction of a manifold to four points left out counts as missed under two conditions: it
/// overlaps by more than `sunk_overlap` (share of the smaller radius), and it lies deeper than the deepest kept
/// point by more than `sunk_overlap` plus `sunk_share` of that point's depth. Smaller values give heaps of aligned
/// boxes a third more manifolds; with larger ones boxes rock before the point is added (bench_contact "pile of
/// 1000"). Test: PairMemory.NoReducedPointSinksUndetected.
inline constexpr double sunk_overlap = 1e-5;
inline constexpr double sunk_share = 0.1;

/// Contacts at gaps below this share of the smaller body take part in one event-driven impact, with the touching
/// contacts of the same faces. Not fitted: far above rounding, and below the tolerance of resting contact.
inline constexpr double impact_touch = 1e-9;

}  // namespace tumble::tuning
