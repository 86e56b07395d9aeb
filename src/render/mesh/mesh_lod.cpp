#include "render/mesh/mesh_lod.h"

#include "render/mesh/triangle_distance.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tumble {
namespace {

constexpr double finest_deviation = 1.0 / 512.0;  // of the ball's radius: a mesh with a radius of 128 pixels

// A level with fewer triangles saves nothing: setting up a batch costs as much.
constexpr std::size_t few_triangles = 96;

// With more triangles, the check of a level would take minutes and gigabytes.
constexpr std::size_t many_triangles = 500'000;

// meshoptimizer's errors are quadrics and can be below the true ones; then a smaller error is requested.
constexpr int most_tries = 6;
constexpr double next_try = 0.6;

using Indices = std::vector<std::uint32_t>;

Vec3 position(const MeshAsset::Vertex& v) {
    return {double(v.position[0]), double(v.position[1]), double(v.position[2])};
}

std::vector<NearSurface::Triangle> triangles_of(const MeshAsset& asset, const Indices& indices) {
    std::vector<NearSurface::Triangle> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        triangles.push_back({position(asset.vertices[indices[i]]), position(asset.vertices[indices[i + 1]]),
                             position(asset.vertices[indices[i + 2]])});
    return triangles;
}

bool near_enough(const MeshAsset& asset, const NearSurface& whole, const Indices& fewer, double deviation) {
    if (fewer.empty()) return false;
    std::vector<NearSurface::Triangle> triangles = triangles_of(asset, fewer);
    for (const auto& [a, b, c] : triangles)
        for (const Vec3& point :
             {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a)), Vec3((a + b + c) / 3.0)})
            if (!whole.holds(point)) return false;
    const NearSurface surface(std::move(triangles), deviation);
    return std::all_of(asset.vertices.begin(), asset.vertices.end(),
                       [&](const MeshAsset::Vertex& vertex) { return surface.holds(position(vertex)); });
}

Indices fewer_triangles(const MeshAsset& asset, double deviation) {
    constexpr std::size_t stride = sizeof(MeshAsset::Vertex);
    const float* positions = asset.vertices.front().position;
    const float scale = meshopt_simplifyScale(positions, asset.vertices.size(), stride);
    const NearSurface whole(triangles_of(asset, asset.indices), deviation);
    Indices fewer(asset.indices.size());
    double asked = deviation;
    for (int i = 0; i < most_tries; ++i, asked *= next_try) {
        fewer.resize(asset.indices.size());
        fewer.resize(meshopt_simplify(fewer.data(), asset.indices.data(), asset.indices.size(), positions,
                                      asset.vertices.size(), stride, 3, float(asked / double(scale)), 0, nullptr));
        if (near_enough(asset, whole, fewer, deviation)) return fewer;
    }
    return asset.indices;
}

}  // namespace

double deviation_of_level(const RenderBody& proxy, std::size_t level) {
    return level == 0 ? 0.0 : proxy.bound_radius * finest_deviation * std::ldexp(1.0, int(level) - 1);
}

std::size_t level_for(const RenderBody& proxy, const RenderScene& scene, double deviation) {
    const std::size_t triangles = scene.meshes[proxy.mesh].asset->indices.size() / 3;
    if (scene.mesh_triangles <= most_whole_triangles || triangles <= few_triangles || triangles > many_triangles)
        return 0;
    std::size_t level = 0;
    while (level + 1 < mesh_levels && deviation_of_level(proxy, level + 1) <= deviation) ++level;
    return level;
}

std::size_t level_in_view(const RenderBody& proxy, const RenderScene& scene, const Vec3& center, const Camera& view) {
    // Away from the center of the view, a deviation appears larger by the factor |p| / depth.
    const double depth = center.dot(view.forward()) - proxy.bound_radius, distance = center.norm() + proxy.bound_radius;
    if (!(depth > 0.0) || scene.meshes[proxy.mesh].charts || scene.meshes[proxy.mesh].paint) return 0;
    return level_for(proxy, scene, most_detail_error * view.pixel_size() * depth * depth / distance);
}

MeshLod simplify(const RenderMesh& mesh, double deviation) {
    const MeshAsset& asset = *mesh.asset;
    const Indices indices = fewer_triangles(asset, deviation);
    MeshLod detail;
    std::map<std::uint32_t, std::uint32_t> kept;
    std::map<std::array<float, 3>, std::uint32_t> welded;
    Indices corners;
    for (const std::uint32_t old : indices) {
        const auto [place, is_new] = kept.try_emplace(old, std::uint32_t(detail.vertices.size()));
        const MeshAsset::Vertex& vertex = asset.vertices[old];
        if (is_new) {
            detail.vertices.push_back(vertex);
            detail.sample_of_vertex.push_back(mesh.sample_of_vertex[old]);
        }
        detail.indices.push_back(place->second);
        const auto [point, is_new_point] =
            welded.try_emplace({vertex.position[0], vertex.position[1], vertex.position[2]},
                               std::uint32_t(detail.surface.vertices.size()));
        if (is_new_point) detail.surface.vertices.push_back(position(vertex));
        corners.push_back(point->second);
    }
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        detail.surface.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    return detail;
}

MeshLods::MeshLods(const RenderScene& scene) : scene_(&scene), details_(scene.meshes.size() * (mesh_levels - 1)) {}

const MeshLod& MeshLods::at(std::size_t mesh, std::size_t level) {
    std::optional<MeshLod>& detail = details_[mesh * (mesh_levels - 1) + level - 1];
    if (!detail) {
        const RenderMesh& proxy = scene_->meshes[mesh];
        detail = simplify(proxy, proxy.half_extent.norm() * finest_deviation * std::ldexp(1.0, int(level) - 1));
    }
    return *detail;
}

}  // namespace tumble
