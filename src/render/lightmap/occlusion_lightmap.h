// Lightmaps for the AO of large fixed bodies, with texels as fine as the AO radius of moving bodies: charts for meshes
// (chart_unwrap.h), octahedral maps for balls. Texels are grouped into blocks with bounds, so that only blocks near a
// moving body are updated, and only changed ones are redrawn.
#pragma once

#include "core/vector.h"
#include "render/lightmap/chart_unwrap.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct OcclusionLightmap {
    static constexpr int block = 8;   // texels per side
    static constexpr int group = 64;  // texels per side of a group of blocks
    struct Block {
        int x, y, width, height;  // texels
        Bounds bounds;            // of all points that these texels shade; body frame, m
    };
    struct Group {
        std::uint32_t first, end;  // blocks
        Bounds bounds;
    };
    int width = 0, height = 0;                             // texels
    std::vector<std::array<float, 3>> positions, normals;  // of each texel, row by row; body frame, m
    std::vector<Block> blocks;
    std::vector<Group> groups;
};

/// Moves the texels out of the charts.
OcclusionLightmap lightmap_of_mesh(ChartedMesh& charts);

/// A ball with `texels` per side.
OcclusionLightmap lightmap_of_ball(double radius, int texels);

/// The unit vector of a point in [-1, 1]^2. Meyer et al. 2010, On Floating-Point Normal Vectors: octahedral map.
Eigen::Vector3f octahedral(float x, float y);

}  // namespace tumble
