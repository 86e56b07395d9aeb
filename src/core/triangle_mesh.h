// A triangle mesh as the simulation sees it: points and the triangles between them, nothing for drawing.
#pragma once

#include "core/vector.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// Vertices (m, in the mesh's own frame) and triangles as counter-clockwise vertex indices.
/// Loaders weld equal positions first, so that neighbors share vertices and edges can be matched.
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    Bounds bounds() const;
};

/// How the surface closes.
struct Closedness {
    std::size_t open_edges = 0;          // used by one triangle only
    std::size_t crowded_edges = 0;       // used by more than two, or twice in the same direction
    double signed_volume = 0.0;          // m^3; negative when the faces look inward
    bool closed() const { return open_edges == 0 && crowded_edges == 0; }
};

/// A mesh is closed when every edge is used once in each direction.
Closedness closedness(const TriangleMesh& mesh);

}  // namespace tumble
