// Constants of the broad phase, the narrow phase and the spatial sort.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Contact points are kept up to this gap (share of the smaller body's radius), plus the distance that the bodies
/// may approach in a step: a rocking box has the corners that it lands on. Related test:
/// Rocking.LosesNoMoreThanItsLandingsTake.
inline constexpr double speculative = 0.02;

/// A contact point without a partner of the same features takes the impulse of an old point up to this distance
/// away (share of the smaller radius): corners that change places on a rocking box carry the same load. Related
/// test: NarrowPhaseManifold.TakesTheNearestPointWhenFeaturesChange.
inline constexpr double matching_distance = 0.1;

/// Two bodies whose relative motion is below this share of the smaller radius keep their manifold. Its points may
/// lie this far from those of a new search; their separations are exact in each step. Test:
/// PairMemory.AgreesWithFreshManifolds.
inline constexpr double reuse_motion = 2e-3;

/// Shapes of many corners are searched for missed points while their motion since the last search is below this
/// share of the radius: such a body rocks. A body that rolls over its corners has new points in each step. Related
/// test: ContactRest.ACoinLiesDown.
inline constexpr double missed_motion = 0.05;

/// Bounds of the broad phase are larger than the body by `fat_bounds` (share of its radius) and extend over its
/// motion in `fat_steps` steps. On heaps of 1000 boxes, twice the margin gives three times as many pairs that do
/// not touch, and half as many searches (bench_contact "pile of 1000").
inline constexpr double fat_bounds = 0.05;
inline constexpr double fat_steps = 8.0;

/// Number of moving bodies from which on bodies are sorted by place in memory (spatial_sort.h), and number of
/// bodies in a vertical column. Limits the cost.
inline constexpr std::size_t ordered_bodies = 512;
inline constexpr std::size_t ordered_column = 32;

}  // namespace tumble::tuning
