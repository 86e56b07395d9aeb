// In what order bodies lie in memory. A step walks over them many times; what touches should be near, for a core's caches, and
// each thread's share in one piece: where two cores write to lines that alternate, the look-ahead of each takes the other's away
// (measured: twice the time of what writes to bodies, with two threads).
#pragma once

#include "sim/dynamics/body.h"

#include <cstdint>
#include <vector>

namespace tumble {

/// Moves the bodies, and tells which of them (by its place before) lies where: what is fixed or kinematic first, then columns along
/// gravity (m/s^2), for what falls stays above what it falls on, each ordered by height. They are cut at the median across gravity,
/// of the longer side first (k-d tree, Bentley 1975); without gravity along any side. Fewer than tuning::ordered_bodies that move
/// stay in the scene's order, all of them: they fit a core's cache in any order, and a mirrored scene's motion stays the mirror image.
std::vector<std::uint32_t> put_in_memory_order(std::vector<Body>& bodies, const Vec3& gravity);

}  // namespace tumble
