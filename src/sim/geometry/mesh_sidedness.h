// Sidedness of a point relative to an open mesh. A triangle's own plane does not decide: beside a crease a point may be
// in front of the mesh and yet behind the plane of a triangle beyond the crease. The nearest point of the mesh decides
// (Baerentzen and Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal").
#pragma once

#include "core/disjoint_sets.h"
#include "sim/geometry/shapes/mesh.h"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

struct SideScratch {
    std::vector<char> behind;  // per triangle of the query: the point is behind it
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_edges;
    DisjointSets joined;
    std::vector<std::uint32_t> piece;  // per triangle of the query: the first triangle of its connected piece
    struct Piece {                     // per triangle of the query, valid for the first ones
        bool mixed = false;            // true if the planes disagree
        double square = 0.0;           // m^2, least squared distance, to the triangle `nearest`
        std::uint32_t nearest = CollisionMesh::none;
        std::optional<bool> behind;
    };
    std::vector<Piece> pieces;
};

/// Fills `behind` for each of `triangles`, which are those near the point. Triangles connected by edges have it on the
/// same side, unless the nearest point is on the border; there each triangle's plane decides, as for a rod that leans
/// out of a bowl.
void find_sides(const CollisionMesh& mesh, std::span<const std::uint32_t> triangles, const Vec3& point,
                SideScratch& scratch);

}  // namespace tumble
