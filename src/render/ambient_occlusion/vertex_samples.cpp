#include "render/ambient_occlusion/vertex_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace tumble {
namespace {

constexpr std::size_t most_samples = 2000;  // each is recomputed in every frame, for every body with this mesh
constexpr std::size_t most_coarse_samples = 64;

Vec3 vec3(const float (&v)[3]) { return {double(v[0]), double(v[1]), double(v[2])}; }

// Grid cell and octant of a point.
using Group = std::array<int, 4>;

Group group_of(const VertexSample& point, const Vec3& low, double cell) {
    const Vec3 at = (point.position - low) / cell;
    const int octant = (point.normal[0] < 0.0) + 2 * (point.normal[1] < 0.0) + 4 * (point.normal[2] < 0.0);
    return {int(std::floor(at.x())), int(std::floor(at.y())), int(std::floor(at.z())), octant};
}

bool share(const RenderMesh& mesh, const std::vector<VertexSample>& points, double cell, std::size_t most,
           std::vector<VertexSample>& shared, std::vector<std::uint32_t>& of_point) {
    shared.clear();
    of_point.clear();
    std::map<Group, std::uint32_t> groups;
    const Vec3 low = mesh.bound_center - mesh.half_extent;
    for (const VertexSample& point : points) {
        const auto [place, is_new] = groups.try_emplace(group_of(point, low, cell), std::uint32_t(shared.size()));
        if (is_new) shared.push_back(point);
        of_point.push_back(place->second);
        if (shared.size() > most) return false;
    }
    return true;
}

// Shares samples among vertices, with the finest grid that `most` samples allow.
void share(const RenderMesh& mesh, const std::vector<VertexSample>& points, std::size_t most,
           std::vector<VertexSample>& shared, std::vector<std::uint32_t>& of_point) {
    if (points.size() <= most) {
        shared = points;
        of_point.resize(points.size());
        std::iota(of_point.begin(), of_point.end(), 0u);
        return;
    }
    double cell = std::max(mesh.half_extent.maxCoeff(), 1e-30) / 32.0;
    while (!share(mesh, points, cell, most, shared, of_point)) cell *= 1.25;
}

}  // namespace

void set_vertex_samples(RenderMesh& mesh) {
    std::vector<VertexSample> vertices;
    for (const MeshAsset::Vertex& vertex : mesh.asset->vertices)
        vertices.push_back({vec3(vertex.position), vec3(vertex.normal)});
    share(mesh, vertices, most_samples, mesh.vertex_samples, mesh.sample_of_vertex);
    share(mesh, mesh.vertex_samples, most_coarse_samples, mesh.coarse_samples, mesh.coarse_of_sample);
}

}  // namespace tumble
