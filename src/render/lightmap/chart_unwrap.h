// Chart unwrapping of a large mesh, for AO over its whole surface instead of at its vertices only. Connected triangles
// that face the same of six directions (+-x, +-y, +-z) form a chart, projected along that axis. A surface steeper than
// 45 degrees belongs to another chart, so texels are stretched by 1.8 at most. Charts are packed into one rectangle of
// texels, each with a border, so that interpolation between texels stays within the chart.
#pragma once

#include "scene/description/description.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

struct ChartedMesh {
    /// A rectangle of texels, from (x, y) of the whole on.
    struct Chart {
        int x, y, width, height;
        int axis;  // projection axis
    };
    double cell = 0.0;          // m, distance of texels
    int width = 0, height = 0;  // texels
    std::vector<Chart> charts;
    std::vector<MeshAsset::Vertex> vertices;   // for drawing, one copy per chart
    std::vector<std::array<float, 2>> texels;  // of each vertex; the center of the first texel is at 0, 0
    std::vector<std::uint32_t> indices;        // the asset's triangles in their order

    /// Positions, normals and heights of the texels, row by row.
    std::vector<std::array<float, 3>> positions, normals;
    std::vector<std::array<float, 2>>
        heights;  // range of heights that the texel shades, along the chart's axis, m; (1, 0)
                  // without a surface within one and a half texels
    bool used(std::size_t texel) const { return heights[texel][0] <= heights[texel][1]; }
};

/// Empty if more than `most_texels` are needed, or too many per side.
std::optional<ChartedMesh> make_mesh_charts(const MeshAsset& asset, double cell, std::size_t most_texels);

}  // namespace tumble
