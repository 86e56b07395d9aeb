#include "core/triangle_mesh.h"

#include <map>
#include <utility>

namespace tumble {

Bounds TriangleMesh::bounds() const {
    Bounds b;
    for (const Vec3& v : vertices) b.add(v);
    return b;
}

Closedness closedness(const TriangleMesh& mesh) {
    Closedness result;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;   // along, against min -> max
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            auto& use = uses[std::minmax(a, b)];
            ++(a < b ? use.first : use.second);
        }
        // The tetrahedron from the first vertex: sixths of the triple product sum to the volume.
        const Vec3& o = mesh.vertices[0];
        const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
        result.signed_volume += a.dot(b.cross(c)) / 6.0;
    }
    for (const auto& [edge, use] : uses) {
        if (use.first + use.second == 1) ++result.open_edges;
        else if (use.first != 1 || use.second != 1) ++result.crowded_edges;
    }
    return result;
}

}  // namespace tumble
