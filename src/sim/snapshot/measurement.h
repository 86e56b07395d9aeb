// Energy, momenta and contacts of the present world: the rows of the energy table and of `tumble info`.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"
#include "sim/snapshot/report.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Energies and momenta over the dynamic bodies: kinetic 1/2 P.v + 1/2 L.omega, potential -sum m g.x, L about the
/// world's origin. `origin` (m, world): origin of the bodies' coordinates.
Measurement measure_motion(const std::vector<Body>& bodies, const Vec3& gravity, const Vec3& origin);

/// Adds the number of touching points and the deepest overlap.
void measure_contacts(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies, Measurement& m);

/// The overlaps of touching bodies, ascending. `scene_index`: by body, its index in the scene.
std::vector<Overlap> overlaps_of(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies,
                                 std::span<const std::uint32_t> scene_index);

BodyReport describe(const Body& body);

}  // namespace tumble
