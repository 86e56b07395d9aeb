#include "render/lightmap/occlusion_lightmap.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Interpolation: points within one texel of a changed texel, plus a tenth for rounding.
constexpr double to_next = 1.1;

constexpr double steepest_ball =
    1.8;  // spacing of the texels of an octahedral map, relative to the mean, near its center lines

Vec3 texel_center(const OcclusionLightmap& surface, std::size_t texel) {
    const auto& p = surface.positions[texel];
    return {double(p[0]), double(p[1]), double(p[2])};
}

struct Region {
    int x, y, width, height;  // texels
};

// `used(texel)`; `add(texel, bounds)` extends the bounds by the texel's points.
template <class Used, class Add>
void add_blocks(OcclusionLightmap& surface, const Region& region, const Used& used, const Add& add) {
    const auto at = [&](int x, int y) { return std::size_t(y) * std::size_t(surface.width) + std::size_t(x); };
    const auto add_block = [&](int x, int y, int columns, int rows) {
        OcclusionLightmap::Block b{x, y, columns, rows, {}};
        std::size_t any = 0;
        for (int j = y; j < y + rows; ++j)
            for (int i = x; i < x + columns; ++i) {
                if (!used(at(i, j))) continue;
                any = at(i, j);
                add(any, b.bounds);
            }
        if (b.bounds.empty()) return;
        for (int j = y; j < y + rows; ++j)  // texels without a surface join any block
            for (int i = x; i < x + columns; ++i) {
                if (used(at(i, j))) continue;
                surface.positions[at(i, j)] = surface.positions[any];
                surface.normals[at(i, j)] = surface.normals[any];
            }
        surface.blocks.push_back(b);
        surface.groups.back().bounds.add(b.bounds);
    };
    for (int y = 0; y < region.height; y += OcclusionLightmap::group)
        for (int x = 0; x < region.width; x += OcclusionLightmap::group) {
            surface.groups.push_back({std::uint32_t(surface.blocks.size()), 0, {}});
            const int end_x = std::min(x + OcclusionLightmap::group, region.width),
                      end_y = std::min(y + OcclusionLightmap::group, region.height);
            for (int j = y; j < end_y; j += OcclusionLightmap::block)
                for (int i = x; i < end_x; i += OcclusionLightmap::block)
                    add_block(region.x + i, region.y + j, std::min(OcclusionLightmap::block, end_x - i),
                              std::min(OcclusionLightmap::block, end_y - j));
            surface.groups.back().end = std::uint32_t(surface.blocks.size());
            if (surface.groups.back().first == surface.groups.back().end) surface.groups.pop_back();
        }
}

}  // namespace

Eigen::Vector3f octahedral(float x, float y) {
    const float z = 1.0f - std::abs(x) - std::abs(y);
    if (z >= 0.0f) return Eigen::Vector3f(x, y, z).normalized();
    return Eigen::Vector3f((1.0f - std::abs(y)) * (x >= 0.0f ? 1.0f : -1.0f),
                           (1.0f - std::abs(x)) * (y >= 0.0f ? 1.0f : -1.0f), z)
        .normalized();
}

OcclusionLightmap lightmap_of_mesh(ChartedMesh& charts) {
    OcclusionLightmap surface;
    surface.width = charts.width;
    surface.height = charts.height;
    surface.positions = std::move(charts.positions);
    surface.normals = std::move(charts.normals);
    for (const ChartedMesh::Chart& c : charts.charts) {
        Vec3 around = Vec3::Constant(to_next * charts.cell);
        around[c.axis] = 0.0;
        add_blocks(
            surface, {c.x, c.y, c.width, c.height}, [&](std::size_t i) { return charts.used(i); },
            [&](std::size_t i, Bounds& bounds) {
                Vec3 p = texel_center(surface, i);
                for (const float height : charts.heights[i]) {
                    p[c.axis] = double(height);
                    bounds.add(p - around);
                    bounds.add(p + around);
                }
            });
    }
    charts.heights = {};
    return surface;
}

OcclusionLightmap lightmap_of_ball(double radius, int texels) {
    OcclusionLightmap surface;
    surface.width = surface.height = texels;
    for (int j = 0; j < texels; ++j)
        for (int i = 0; i < texels; ++i) {
            const auto coordinate = [&](int k) { return 2.0f * float(k) / float(texels - 1) - 1.0f; };
            const Eigen::Vector3f normal = octahedral(coordinate(i), coordinate(j));
            surface.normals.push_back({normal.x(), normal.y(), normal.z()});
            const Eigen::Vector3f position = float(radius) * normal;
            surface.positions.push_back({position.x(), position.y(), position.z()});
        }
    const double apart = steepest_ball * pi * radius / (texels - 1);
    const Vec3 around = Vec3::Constant(to_next * apart);
    add_blocks(
        surface, {0, 0, texels, texels}, [](std::size_t) { return true; },
        [&](std::size_t i, Bounds& bounds) {
            bounds.add(texel_center(surface, i) - around);
            bounds.add(texel_center(surface, i) + around);
        });
    return surface;
}

}  // namespace tumble
