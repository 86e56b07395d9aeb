// Constants of the broad phase, the narrow phase and the spatial sort.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Contact points are kept up to this gap (share of the smaller body's radius), plus the distance that the bodies
/// may approach in a step: a rocking box has the corners that it lands on. Related test:
/// Rocking.LosesNoMoreThanItsLandingsTake.
inline constexpr double speculative = 0.02;

/// Two bodies whose relative motion is below this share of the smaller radius keep their manifold. Its points may
/// lie this far from those of a new search; their separations are exact in each step. Test:
/// PairMemory.AgreesWithFreshManifolds.
inline constexpr double reuse_motion = 2e-3;

}  // namespace tumble::tuning
