// Constants of continuous collision detection (CCD).
#pragma once

namespace tumble::tuning {

/// plus this share of their distance from the origin. Not fitted: some units of rounding.
inline constexpr double impact_position_rounding = 1e-15;

/// Approach speeds below this share of the bodies' own speeds are rounding. Not fitted: some ten units of rounding.
inline constexpr double impact_speed_rounding = 1e-14;

/// Shortest step of the search for a time of impact, s. Not fitted: below any interval between impacts.
inline constexpr double impact_time = 1e-15;

/// Time-stepped motion is checked by CCD if a body moves in a step by more than this share of both inner radii
/// together. Slower bodies are pushed out on the right side. Related tests: ThinWall.FromAnyDistance and
/// ThinWall.LandingBodiesAreStopped.
inline constexpr double fast_share = 0.5;

}  // namespace tumble::tuning
