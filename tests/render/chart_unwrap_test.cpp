// Charts: positions interpolated between texels are on the surface, also where it bends, folds or overlaps itself.
#include "example_scenes.h"
#include "random.h"

#include "core/deterministic_math.h"
#include "render/lightmap/chart_unwrap.h"
#include "render/lightmap/occlusion_lightmap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace tumble::chart_unwrap_test {
namespace {

// A spiral ramp: each turn is 1 m above the one below, and all are connected.
std::shared_ptr<const MeshAsset> spiral_asset(int turns) {
    auto asset = std::make_shared<MeshAsset>();
    constexpr int steps = 24;
    for (int i = 0; i <= turns * steps; ++i) {
        const SinCos at = sincos(2.0 * pi * i / steps);
        for (const double radius : {1.0, 3.0})
            asset->vertices.push_back(
                {{float(radius * at.cos), float(i) / steps, float(radius * at.sin)}, {0.0f, 1.0f, 0.0f}});
        if (i == 0) continue;
        const auto k = std::uint32_t(2 * i);
        asset->indices.insert(asset->indices.end(), {k - 2, k, k + 1, k - 2, k + 1, k - 1});
    }
    return asset;
}

Vec3 vec3(const std::array<float, 3>& v) { return {double(v[0]), double(v[1]), double(v[2])}; }
Vec3 position(const MeshAsset::Vertex& v) {
    return {double(v.position[0]), double(v.position[1]), double(v.position[2])};
}

// Largest distance of a point from the position interpolated from its texels; the point must be within the bounds of a
// used one.
double worst(const MeshAsset& asset, double cell) {
    auto charts = make_mesh_charts(asset, cell, 1'000'000);
    EXPECT_TRUE(charts);
    if (!charts) return 1.0;
    EXPECT_EQ(charts->indices.size(), asset.indices.size());
    EXPECT_EQ(charts->texels.size(), charts->vertices.size());
    Random random(5);
    double most = 0.0;
    for (std::size_t i = 0; i + 2 < charts->indices.size(); i += 3)
        for (int sample = 0; sample < 8; ++sample) {
            double u = random.between(0.0, 1.0), v = random.between(0.0, 1.0);
            if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
            const double shares[3] = {1.0 - u - v, u, v};
            Vec3 there = Vec3::Zero(), shown = Vec3::Zero();
            double x = 0.0, y = 0.0;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = charts->indices[i + k];
                EXPECT_EQ(position(charts->vertices[vertex]), position(asset.vertices[asset.indices[i + k]]));
                there += shares[k] * position(charts->vertices[vertex]);
                x += shares[k] * double(charts->texels[vertex][0]);
                y += shares[k] * double(charts->texels[vertex][1]);
            }
            const int a = int(x), b = int(y);
            for (int n = 0; n < 4; ++n) {
                const int column = a + (n & 1), row = b + n / 2;
                const double weight = ((n & 1) != 0 ? x - a : 1.0 - (x - a)) * (n / 2 != 0 ? y - b : 1.0 - (y - b));
                const std::size_t at = std::size_t(row) * std::size_t(charts->width) + std::size_t(column);
                EXPECT_TRUE(column < charts->width && row < charts->height && charts->used(at));
                shown += weight * vec3(charts->positions[at]);
            }
            most = std::max(most, (shown - there).norm() / cell);
        }
    return most;
}

TEST(ChartedMesh, ShowTheSurfaceBetweenTexels) {
    for (const double cell : {0.03, 0.1, 0.3}) {
        EXPECT_LT(worst(*sheet_asset(8.0, 1), cell), 1e-4) << cell;
        EXPECT_LT(worst(*sheet_asset(8.0, 60), cell), 1e-4) << cell;
        EXPECT_LT(worst(*torus_asset(2.0, 0.7, 48, 24), cell), 1.0) << cell;
        EXPECT_LT(worst(*spiral_asset(3), cell), 1.0) << cell << ": floors above each other must not share texels";
    }
}

// No two charts overlap, borders included: interpolation stays within one chart.
TEST(ChartedMesh, LieSideBySide) {
    for (const auto& asset : {torus_asset(2.0, 0.7, 48, 24), spiral_asset(3)}) {
        const auto charts = make_mesh_charts(*asset, 0.1, 1'000'000);
        ASSERT_TRUE(charts);
        std::set<std::pair<int, int>> taken;
        for (const ChartedMesh::Chart& c : charts->charts)
            for (int y = c.y; y < c.y + c.height; ++y)
                for (int x = c.x; x < c.x + c.width; ++x) {
                    EXPECT_TRUE(x >= 0 && y >= 0 && x < charts->width && y < charts->height);
                    EXPECT_TRUE(taken.emplace(x, y).second) << x << ", " << y;
                }
    }
}

TEST(ChartedMesh, AreNoneWhereTheyDoNotFit) {
    EXPECT_FALSE(make_mesh_charts(*sheet_asset(8.0, 1), 0.001, 1'000'000'000)) << "8000 to a side";
    EXPECT_FALSE(make_mesh_charts(*sheet_asset(8.0, 1), 0.1, 1000));
}

// Every used texel is in one block, and its point is in the bounds of the block and of its group.
TEST(OcclusionLightmap, BlocksHoldTheirTexels) {
    auto charts = make_mesh_charts(*torus_asset(2.0, 0.7, 48, 24), 0.1, 1'000'000);
    ASSERT_TRUE(charts);
    std::set<std::pair<int, int>> used;
    for (int y = 0; y < charts->height; ++y)
        for (int x = 0; x < charts->width; ++x)
            if (charts->used(std::size_t(y * charts->width + x))) used.emplace(x, y);
    const OcclusionLightmap mesh = lightmap_of_mesh(*charts), ball = lightmap_of_ball(3.0, 100);
    std::size_t in_blocks = 0;
    for (const OcclusionLightmap* surface : {&mesh, &ball})
        for (const OcclusionLightmap::Group& group : surface->groups)
            for (std::uint32_t i = group.first; i < group.end; ++i) {
                const OcclusionLightmap::Block& block = surface->blocks[i];
                EXPECT_EQ(block.bounds.min, block.bounds.min.cwiseMax(group.bounds.min));
                EXPECT_EQ(block.bounds.max, block.bounds.max.cwiseMin(group.bounds.max));
                for (int y = block.y; y < block.y + block.height; ++y)
                    for (int x = block.x; x < block.x + block.width; ++x)
                        in_blocks += surface == &mesh ? used.erase({x, y}) : 1;
            }
    EXPECT_TRUE(used.empty());
    EXPECT_GE(in_blocks, std::size_t(100 * 100));
}

}  // namespace
}  // namespace tumble::chart_unwrap_test
