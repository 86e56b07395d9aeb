// Which side of an open surface a point is on. A triangle's own plane does not tell: beside a crease a point may be in front
// of the surface and yet behind the plane of a triangle beyond the crease. The surface's nearest place tells (Baerentzen and
// Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal").
#pragma once

#include "sim/geometry/mesh_shape.h"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

struct SideScratch {
    std::vector<char> behind;   // one a triangle asked for: the point is behind it
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_edges;
    std::vector<std::uint32_t> piece;   // one a triangle: the first of those it hangs together with
    struct Piece {                      // one a triangle, of those that are first
        bool mixed = false;             // the planes disagree
        double square = 0.0;            // m^2, of the least distance, to the triangle `nearest`
        std::uint32_t nearest = CollisionMesh::none;
        std::optional<bool> behind;
    };
    std::vector<Piece> pieces;
};

/// Fills `behind` for each of `triangles`, which are those near the point. Those that hang together by their edges have it on
/// the same side, unless it is nearest to the surface's rim, where each one's plane must do: a rod leans out of a bowl.
void find_sides(const CollisionMesh& surface, std::span<const std::uint32_t> triangles, const Vec3& point,
                SideScratch& scratch);

}  // namespace tumble
