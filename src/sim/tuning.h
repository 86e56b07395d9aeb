// Every tuning constant of the simulation, with its unit and its reason.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Two surfaces touch when nearer than this part of the smaller body's radius: far above rounding, far below sight.
inline constexpr double touch = 1e-6;

/// Contact points are kept up to this part of the smaller body's radius apart (and as far as the bodies can come in a
/// step), so that a rocking box already knows the corners it will land on.
inline constexpr double speculative = 0.02;

/// Bounds in the broad phase are grown by this part of a body's radius, and by its way in so many steps:
/// a rebuild every few steps for falling bodies, none for resting ones.
inline constexpr double fat_bounds = 0.1;
inline constexpr double fat_steps = 8.0;

/// Slower approaches than this times |g| h do not bounce. A resting contact meets gravity's own g h each step;
/// twice that is told apart from it.
inline constexpr double restitution_threshold = 2.0;

/// Sweeps of the contact solver in a step: few are needed with last step's impulses to start from.
inline constexpr int solver_sweeps = 50;
/// A sweep that changes no velocity by more than this part of |g| h ends the solve: 1e-4 of what gravity adds in a step.
inline constexpr double solver_tolerance = 1e-4;
/// Floor of that tolerance, m/s, for scenes without gravity.
inline constexpr double solver_floor = 1e-12;

/// Share of an overlap that is pushed out in a step. Less leaves boxes sunk after a hard landing, more makes heaps tremble.
inline constexpr double push_share = 0.2;
inline constexpr int push_sweeps = 12;
/// Overlaps below this part of the smaller radius stay: they keep the contact alive.
inline constexpr double push_slop = 1e-5;
/// Fastest push-out, in radii per second: deep overlaps at the start dissolve visibly, not with a bang.
inline constexpr double push_limit = 5.0;

/// Passes of an impact before what is left is taken as inelastic: a chain of n contacts needs about n, jammed sets never end.
inline constexpr int impact_passes = 200;
/// Sweeps of the non-negative least squares inside a pass, and the relative change at which it has converged.
inline constexpr int impact_sweeps = 400;
inline constexpr double impact_tolerance = 1e-14;

/// A body whose surface strayed by less than this part of its radius for this long (s) is at rest.
inline constexpr double sleep_drift = 2e-4;
inline constexpr double sleep_time = 0.5;

/// Fewer pairs or islands than this are not worth waking the other threads for.
inline constexpr std::size_t parallel_grain = 64;

}  // namespace tumble::tuning
