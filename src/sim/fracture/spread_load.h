// The load of a contact over an area, on the cells of a piece that the area covers. A manifold has at most four points,
// which stand for the pressure between two faces; as forces on four cells they would break the corners off.
#pragma once

#include "sim/fracture/breakable_body.h"

#include <span>
#include <vector>

namespace tumble {

/// A force on a piece at a point, in the frame of the whole.
struct PointForce {
    Vec3 point = Vec3::Zero();  // m, from the body's origin
    Vec3 force = Vec3::Zero();  // N, or N s
};
struct CellForce {
    std::uint32_t cell;
    PointForce at;
};

/// The forces of one manifold, along `into` (unit, into the piece), on its cells. Three points or more with a pressure
/// that is linear over the faces between them, and nowhere negative, act on all of these faces; others on the cells
/// that are nearest to the points. The sum and the moments are the same.
void spread_load(const BreakableBody& body, std::uint32_t piece, const Vec3& into, std::span<const PointForce> points,
                 std::vector<CellForce>& forces);

}  // namespace tumble
