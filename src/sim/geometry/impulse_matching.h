// Impulse matching: transfers the impulses of the last step to new manifolds, as warm start for the solver.
#pragma once

#include "sim/geometry/manifold.h"

namespace tumble {

/// Transfers the impulses of `old` to `m`, the manifold of the same two bodies found later:
/// - each point gets the impulse of the old point with the same feature;
/// - without such a point, that of the nearest old point not yet taken, if nearer than `reach` (m);
/// - remaining impulses go to the nearest points while the normals agree: a load must not be lost where points change.
/// Friction, its tangent and the torsional friction are transferred too.
void carry_over(const Manifold& old, double reach, Manifold& m);

/// Adds the normal impulses of a removed second manifold to the nearest points of the remaining one.
void hand_over(const Manifold& old, Manifold& m);

}  // namespace tumble
