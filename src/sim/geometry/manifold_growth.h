// Manifolds that grow. Four points of up to eight span almost the same area, but where the load comes to lie beyond them the
// body sinks at a corner that was left out; taken in for another, that one is missing next: the body rocks for ever.
// So such a pair keeps every point it has had and takes in what sank, in a second manifold where one has no room.
#pragma once

#include "sim/geometry/manifold.h"

#include <span>
#include <vector>

namespace tumble {

/// Whether a point left out has sunk below all of a pair of faces' points, by enough to be missed. Separations in m,
/// `radius` the smaller body's.
bool sank(double left_out, double deepest, double radius);

/// The same of a pair looked at anew, where the bodies have moved too far to follow the points: whether those of `before` were not
/// enough. To be asked of shapes with more corners than two manifolds have room for: in heaps of boxes a third more manifolds would
/// come of it.
bool missed(std::span<const Manifold> before, const Manifold& found, std::span<const ContactPoint> left_out, double radius);

/// Chooses among the points of `found` and those left out of it again: all that the manifolds of `before` (one, or two) had,
/// those that sank, and others while there is room. Returns the second manifold, without points where one is enough; what
/// is left out now is appended to `left_out`. Where other faces meet than before, `found` stays as it is.
Manifold grow(std::span<const Manifold> before, double radius, Manifold& found, std::vector<ContactPoint>& left_out);

}  // namespace tumble
