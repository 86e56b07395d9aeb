#include "render/mesh_probes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tumble {
namespace {

constexpr std::size_t most_probes = 2000;  // each is worked out anew in every frame, for every body of this mesh

Vec3 vec3(const float (&v)[3]) { return {double(v[0]), double(v[1]), double(v[2])}; }

// Lattice cell and octant of a vertex.
using Group = std::array<int, 4>;

Group group_of(const MeshAsset::Vertex& vertex, const Vec3& low, double cell) {
    const Vec3 at = (vec3(vertex.position) - low) / cell;
    const int octant = (vertex.normal[0] < 0.0f) + 2 * (vertex.normal[1] < 0.0f) + 4 * (vertex.normal[2] < 0.0f);
    return {int(std::floor(at.x())), int(std::floor(at.y())), int(std::floor(at.z())), octant};
}

bool share(MeshLook& look, double cell) {
    look.probes.clear();
    look.probe_of_vertex.clear();
    std::map<Group, std::uint32_t> groups;
    const Vec3 low = look.bound_center - look.half_extent;
    for (const MeshAsset::Vertex& vertex : look.asset->vertices) {
        const auto [place, is_new] = groups.try_emplace(group_of(vertex, low, cell), std::uint32_t(look.probes.size()));
        if (is_new) look.probes.push_back({vec3(vertex.position), vec3(vertex.normal)});
        look.probe_of_vertex.push_back(place->second);
        if (look.probes.size() > most_probes) return false;
    }
    return true;
}

}  // namespace

void set_mesh_probes(MeshLook& look) {
    const std::vector<MeshAsset::Vertex>& vertices = look.asset->vertices;
    if (vertices.size() <= most_probes) {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            look.probes.push_back({vec3(vertices[i].position), vec3(vertices[i].normal)});
            look.probe_of_vertex.push_back(std::uint32_t(i));
        }
        return;
    }
    double cell = std::max(look.half_extent.maxCoeff(), 1e-30) / 32.0;
    while (!share(look, cell)) cell *= 1.25;
}

}  // namespace tumble
