// A large mesh laid out flat, so that what darkens it is known everywhere on it and not at its vertices only: connected
// triangles that face the same of six ways (+-x, +-y, +-z) are a chart, seen along that axis. Steeper than 45 degrees is
// another chart, so texels are stretched by 1.8 at most. Charts lie side by side in one rectangle of texels, each with a rim
// around it, so that what is interpolated between texels stays within the chart.
#pragma once

#include "scene/description/description.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

struct ChartedMesh {
    /// A rectangle of texels, from (x, y) of all on.
    struct Chart {
        int x, y, width, height;
        int axis;   // that it is seen along
    };
    double cell = 0.0;           // m, between texels
    int width = 0, height = 0;   // texels
    std::vector<Chart> charts;
    std::vector<MeshAsset::Vertex> vertices;       // for drawing, once for each chart that they are in
    std::vector<std::array<float, 2>> texels;      // of each: where it lies; the first texel's middle is at 0, 0
    std::vector<std::uint32_t> indices;            // the asset's triangles in their order

    /// Of each texel, row by row.
    std::vector<std::array<float, 3>> positions, normals;
    std::vector<std::array<float, 2>> heights;     // lowest and highest of what it darkens, along the chart's axis, m; none
                                                   // (1, 0) where there is no surface within one and a half texels
    bool used(std::size_t texel) const { return heights[texel][0] <= heights[texel][1]; }
};

/// None when more than `most_texels` are needed, or too many to a side.
std::optional<ChartedMesh> make_mesh_charts(const MeshAsset& asset, double cell, std::size_t most_texels);

}  // namespace tumble
