#include "sim/collision/triangle_surface.h"

#include "core/error.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tumble {

TriangleSurface make_surface(const TriangleMesh& mesh, const Vec3& origin) {
    TriangleSurface s;
    s.closed = closedness(mesh).closed();
    for (const Vec3& v : mesh.vertices) {
        s.vertices.push_back(v - origin);
        s.radius = std::max(s.radius, s.vertices.back().norm());
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::pair<std::uint32_t, int>>> users;
    std::vector<Bounds> bounds;
    for (const auto& t : mesh.triangles) {
        const Vec3 &a = s.vertices[t[0]], &b = s.vertices[t[1]], &c = s.vertices[t[2]];
        const Vec3 n = (b - a).cross(c - a);
        if (n.norm() == 0.0) continue;
        TriangleSurface::Triangle triangle;
        triangle.vertices = t;
        triangle.normal = n.normalized();
        Bounds box;
        for (int i = 0; i < 3; ++i) {
            const Vec3 &p = s.vertices[t[i]], &q = s.vertices[t[(i + 1) % 3]];
            triangle.outward[i] = (q - p).cross(triangle.normal).normalized();
            users[std::minmax(t[i], t[(i + 1) % 3])].emplace_back(std::uint32_t(s.triangles.size()), i);
            box.add(p);
        }
        s.triangles.push_back(triangle);
        bounds.push_back(box);
    }
    if (s.triangles.empty()) throw InputError("the mesh has no triangle with an area");
    for (const auto& [ends, list] : users) {
        for (const auto& [t, i] : list) s.triangles[t].edge[i] = s.edge_count;
        ++s.edge_count;
        if (list.size() != 2) continue;
        s.triangles[list[0].first].neighbour[list[0].second] = std::int32_t(list[1].first);
        s.triangles[list[1].first].neighbour[list[1].second] = std::int32_t(list[0].first);
    }
    s.tree = BoundsTree(std::move(bounds));
    return s;
}

bool TriangleSurface::owns_normal(const Triangle& triangle, const Vec3& normal, double side) const {
    constexpr double slack = 1e-9;   // sine of the angle forgiven to rounding
    const double up = side * normal.dot(triangle.normal);
    for (int i = 0; i < 3; ++i) {
        const double lean = normal.dot(triangle.outward[i]);
        if (lean <= slack) continue;
        if (triangle.neighbour[i] < 0) continue;   // an open edge: any way over it
        const Vec3 other = triangles[std::size_t(triangle.neighbour[i])].normal;
        // Angles from this normal towards the edge, as (cosine, sine) pairs: ours must not pass the neighbour's.
        const double other_up = other.dot(triangle.normal), other_lean = side * other.dot(triangle.outward[i]);
        if (other_lean <= slack || lean * other_up > other_lean * up + slack) return false;
    }
    return true;
}

}  // namespace tumble
