// What contact has built up since earlier steps goes over to the manifolds found anew: warm starts for the solver.
#pragma once

#include "sim/geometry/manifold.h"

namespace tumble {

/// Takes the impulses of `old` over to `m`, the same two bodies' manifold found later: to each point that of the same
/// feature, and where no feature is the same, that of the nearest old point not yet taken, if nearer than `reach` (m). What
/// is left over then goes to the nearest points, while the normals agree: a load must not be lost where points change.
/// Friction, its tangent and its twist come along.
void carry_over(const Manifold& old, double reach, Manifold& m);

/// The normal impulses of a second manifold that is no longer needed, to the nearest points of what is left.
void hand_over(const Manifold& old, Manifold& m);

}  // namespace tumble
