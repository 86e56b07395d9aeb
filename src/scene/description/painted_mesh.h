// The vertices of a mesh with the colors of its file, one for each different corner, and its triangles by texture.
#pragma once

#include "scene/description/description.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Attributes of a vertex in addition to MeshAsset::Vertex, as in shaders/body.vert.
struct VertexPaint {
    std::array<float, 2> uv;
    std::array<float, 3> color;  // linear light, without the texture
    // Roughness and metallic (below 0: the body's values); alpha below which is a hole (below 0: alpha multiplies the
    // opacity); opacity.
    std::array<float, 4> surface;
    std::array<float, 3> emission;  // linear light
};

struct PaintedMesh {
    /// Consecutive indices that share a texture. `material` has the texture, if any, and its wrapping.
    struct Range {
        const MeshMaterial* material;
        std::size_t first, count;
    };
    std::vector<std::uint32_t> source;  // vertex of the mesh, for each vertex
    std::vector<VertexPaint> paint;     // of each vertex
    std::vector<std::uint32_t> indices;
    std::vector<Range> ranges;
};

/// Corners of triangles, of which each different one is a vertex.
struct PaintedCorners {
    std::vector<std::size_t> vertices;   // one of the corners of each, among all corners of the mesh
    std::vector<std::uint32_t> indices;  // of the triangles, into the vertices
};

/// Corners differ in their vertex of the mesh, their material, their place in a texture, or their color. `indices`: of
/// all triangles of the mesh, in the order of MeshAsset::indices; `triangles`: those to take, in that order.
PaintedCorners different_corners(std::span<const std::uint32_t> indices, const MeshPaint& paint,
                                 std::span<const std::uint32_t> triangles);

/// `indices`: of the triangles of the mesh, in the order of MeshAsset::indices.
PaintedMesh paint_mesh(std::span<const std::uint32_t> indices, const MeshPaint& paint);

}  // namespace tumble
