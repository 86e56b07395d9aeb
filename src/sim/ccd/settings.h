// Constants of continuous collision detection (CCD).
#pragma once

namespace tumble::tuning {

/// Gaps below this share of the bodies' sizes are rounding,
inline constexpr double impact_gap = 1e-13;

/// plus this share of their distance from the origin. Not fitted: some units of rounding.
inline constexpr double impact_position_rounding = 1e-15;

/// Approach speeds below this share of the bodies' own speeds are rounding. Not fitted: some ten units of rounding.
inline constexpr double impact_speed_rounding = 1e-14;

/// At gaps below this share of the smaller body, the separating axis is that of the meeting features. It lies
/// between the rounding of the search for the nearest points and the use of its result. Not fitted.
inline constexpr double impact_near = 1e-7;

/// Points within this share of a feature belong to it. Not fitted: below `impact_near`, above rounding.
inline constexpr double impact_feature = 1e-8;

/// Shortest step of the search for a time of impact, s. Not fitted: below any interval between impacts.
inline constexpr double impact_time = 1e-15;

/// Poses that a search evaluates before it returns its bound: 4 to 70 are usual (spins up to 100 rad/s). Not
/// fitted: a bound of the cost.
inline constexpr int impact_evaluations = 400;

/// Time-stepped motion is checked by CCD if a body moves in a step by more than this share of both inner radii
/// together. Slower bodies are pushed out on the right side. Related tests: ThinWall.FromAnyDistance and
/// ThinWall.LandingBodiesAreStopped.
inline constexpr double fast_share = 0.5;

/// It is also checked if a body moves by more than this share of the smaller inner radius: an unchecked body
/// overlaps by as much for a step. Related test: ThinWall.APlaneStopsThinBodiesAsABoxDoes.
inline constexpr double fast_deepest = 0.9;

/// Bodies that touch when the step begins may overlap by the first share of the radius, or by the second more than
/// they do: the contact solver leaves small approaches, which must not stop fast bodies. Related tests:
/// ThinWall.SlidingBodiesAreStopped and ThinWall.ARackIsBroken.
inline constexpr double fast_overlap = 0.05;
inline constexpr double fast_deeper = 0.01;

/// Rounds in which bodies that stop each other are checked again. Not fitted: beyond them all stop with the first.
/// Related test: ThinWall.BodiesDoNotPassThroughEachOther.
inline constexpr int ccd_rounds = 8;

}  // namespace tumble::tuning
