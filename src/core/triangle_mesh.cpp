#include "core/triangle_mesh.h"

#include <algorithm>
#include <tuple>

namespace tumble {

Bounds TriangleMesh::bounds() const {
    Bounds b;
    for (const Vec3& v : vertices) b.add(v);
    return b;
}

Closedness closedness(const TriangleMesh& mesh) {
    Closedness result;
    struct Use {
        std::uint32_t low, high;  // the edge's vertices
        bool upward;              // used from low to high
        bool operator<(const Use& other) const { return std::tie(low, high) < std::tie(other.low, other.high); }
    };
    std::vector<Use> uses;
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            uses.push_back({std::min(a, b), std::max(a, b), a < b});
        }
        // The tetrahedron from the first vertex: sixths of the triple product sum to the volume.
        const Vec3& o = mesh.vertices[0];
        const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
        result.signed_volume += a.dot(b.cross(c)) / 6.0;
    }
    std::sort(uses.begin(), uses.end());
    for (auto edge = uses.begin(); edge != uses.end();) {
        const auto end = std::upper_bound(edge, uses.end(), *edge);
        const auto upward = std::count_if(edge, end, [](const Use& use) { return use.upward; });
        if (2 * upward != end - edge) ++result.unbalanced_edges;
        if (end - edge == 1)
            ++result.open_edges;
        else if (end - edge != 2 || upward != 1)
            ++result.crowded_edges;
        edge = end;
    }
    return result;
}

}  // namespace tumble
