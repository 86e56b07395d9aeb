// Manifold growth. Four points of up to eight span almost the same area, but where the load lies outside them the body
// sinks at a reduced corner; if that corner replaces another, the other is missing next, and the body rocks without
// end.
// So such a pair keeps every point that it has had and adds points that have sunk, in a second manifold where one has
// no room.
#pragma once

#include "sim/geometry/manifold.h"

#include <span>
#include <vector>

namespace tumble {

/// True if a reduced point has sunk below all points of a pair of faces, by enough to be needed. Separations in m,
/// `radius` that of the smaller body.
bool sank(double reduced, double deepest, double radius);

/// The same for a pair searched anew, because its bodies have moved too far to refresh the points: whether the points
/// of `before` were insufficient. Precondition: a shape with more corners than two manifolds have room for. In heaps of
/// boxes it would add a third more manifolds.
bool missed(std::span<const Manifold> before, const Manifold& found, std::span<const ContactPoint> reduced,
            double radius);

/// Chooses again among the points of `found` and the reduced points: all points of the manifolds of `before` (one or
/// two), points that sank, and others while there is room. Returns the second manifold, without points where one is
/// enough; reduced points are appended to `reduced`. Where other faces meet than before, `found` stays unchanged.
Manifold grow(std::span<const Manifold> before, double radius, Manifold& found, std::vector<ContactPoint>& reduced);

}  // namespace tumble
