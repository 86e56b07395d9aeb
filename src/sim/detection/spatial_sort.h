// Spatial sort: the order of bodies in memory. A step visits them many times; touching bodies should be near each
// other, for the caches of a core, and each thread's share in one piece: where two cores write to alternating lines,
// their prefetchers steal lines from each other (measured: twice the time for writing to bodies, with two threads).
#pragma once

#include "sim/dynamics/body.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Reorders the bodies and returns for each index the former index: fixed and kinematic bodies first, then columns
/// along gravity (m/s^2), because falling bodies stay above those that they fall on, each ordered by height. Columns
/// are cut at the median across gravity, of the longer side first (k-d tree, Bentley 1975); without gravity along any
/// side.
/// With fewer than ordered_bodies moving ones all bodies stay in the scene's order: they fit a core's cache in
/// any order, and a mirrored scene's motion stays the mirror image.
std::vector<std::uint32_t> put_in_memory_order(std::vector<Body>& bodies, const Vec3& gravity);

}  // namespace tumble
