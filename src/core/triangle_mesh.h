// A triangle mesh for the simulation: points and triangles, without data for drawing.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// Vertices (m, mesh frame) and triangles as counter-clockwise vertex indices. Loaders weld equal positions first, so
/// that adjacent triangles share vertices and edges can be matched.
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    Bounds bounds() const;
};

/// Properties of the edges.
struct Closedness {
    std::size_t open_edges = 0;        // used by one triangle only
    std::size_t crowded_edges = 0;     // used by more than two triangles, or twice in the same direction
    std::size_t unbalanced_edges = 0;  // used more often in one direction than in the other
    double signed_volume = 0.0;        // m^3; negative if the faces are oriented inward
    bool closed() const { return open_edges == 0 && crowded_edges == 0; }
    /// The volume does not depend on the origin: of closed meshes, and of such that touch at edges or share faces.
    bool has_volume() const { return unbalanced_edges == 0; }
};

/// A mesh is closed if every edge is used once in each direction.
Closedness closedness(const TriangleMesh& mesh);

/// The connected components of a mesh, and the triangles in them that are wound inconsistently. Two triangles that
/// share an edge without a third one are in one component; an edge with more triangles is a border.
struct MeshComponents {
    static constexpr std::uint32_t none = ~std::uint32_t(0);
    // index of the first triangle of each triangle's component; none: the component is one-sided (Moebius)
    std::vector<std::uint32_t> sheet;
    std::vector<char> flipped;  // true if wound opposite to the first triangle
    std::vector<char> rim;      // true if an edge of its component is a border
};

MeshComponents find_sheets(const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace tumble
