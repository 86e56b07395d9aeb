// Large bodies that never move, laid out in texels as fine as what darkens them: meshes by their charts (mesh_charts.h), balls
// unfolded as all are. Texels come in blocks, each with its place in space, so that only those are looked at that a body is near
// to, and only those are drawn anew that changed.
#pragma once

#include "core/vector.h"
#include "render/lightmap/chart_unwrap.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct OcclusionLightmap {
    static constexpr int block = 8;          // texels to a side
    static constexpr int group = 64;         // texels to a side of a group of blocks
    struct Block {
        int x, y, width, height;             // texels
        Bounds bounds;                       // of all that these texels darken; body frame, m
    };
    struct Group {
        std::uint32_t first, end;            // blocks
        Bounds bounds;
    };
    int width = 0, height = 0;               // texels
    std::vector<std::array<float, 3>> positions, normals;   // of each texel, row by row; body frame, m
    std::vector<Block> blocks;
    std::vector<Group> groups;
};

/// Takes the texels from the charts.
OcclusionLightmap fine_surface_of_mesh(ChartedMesh& charts);

/// A ball of `texels` to a side.
OcclusionLightmap fine_surface_of_ball(double radius, int texels);

/// The unit vector of a point in [-1, 1]^2. Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map.
Eigen::Vector3f octahedral(float x, float y);

}  // namespace tumble
