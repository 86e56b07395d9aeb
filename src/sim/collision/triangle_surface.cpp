#include "sim/collision/triangle_surface.h"

#include "core/error.h"

#include <algorithm>
#include <map>
#include <numeric>
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
            users[std::minmax(t[i], t[(i + 1) % 3])].emplace_back(std::uint32_t(s.triangles.size()), i);
            box.add(s.vertices[t[i]]);
        }
        s.triangles.push_back(triangle);
        bounds.push_back(box);
    }
    if (s.triangles.empty()) throw InputError("the mesh has no triangle with an area");
    for (const auto& [ends, list] : users) {
        for (const auto& [t, i] : list) s.triangles[t].edge[i] = s.edge_count;
        ++s.edge_count;
        if (list.size() != 2) continue;
        const auto opposite = [&](const std::pair<std::uint32_t, int>& user) {
            return std::int32_t(s.triangles[user.first].vertices[(user.second + 2) % 3]);
        };
        s.triangles[list[0].first].across[list[0].second] = opposite(list[1]);
        s.triangles[list[1].first].across[list[1].second] = opposite(list[0]);
    }
    s.ring_start.assign(s.vertices.size() + 1, 0);
    for (const auto& [ends, list] : users)
        for (const std::uint32_t v : {ends.first, ends.second}) ++s.ring_start[v + 1];
    std::partial_sum(s.ring_start.begin(), s.ring_start.end(), s.ring_start.begin());
    s.ring.resize(s.ring_start.back());
    std::vector<std::uint32_t> next = s.ring_start;
    for (const auto& [ends, list] : users) {
        s.ring[next[ends.first]++] = ends.second;
        s.ring[next[ends.second]++] = ends.first;
    }
    s.tree = BoundsTree(std::move(bounds));
    return s;
}

bool TriangleSurface::owns_normal(const Triangle& triangle, const Vec3& normal) const {
    constexpr double slack = 1e-9;   // sine of the angle forgiven to rounding
    const auto farther = [&](std::uint32_t to, std::uint32_t from) {
        const Vec3 way = vertices[to] - vertices[from];
        return normal.dot(way) > slack * way.norm();
    };
    const auto& v = triangle.vertices;
    std::size_t top = 0;
    for (const std::size_t i : {1u, 2u})
        if (farther(v[i], v[top])) top = i;
    const std::size_t next = (top + 1) % 3, last = (top + 2) % 3;
    const bool with_next = !farther(v[top], v[next]), with_last = !farther(v[top], v[last]);
    if (with_next && with_last) return true;   // the triangle's own normal
    if (with_next || with_last) {
        const std::int32_t beyond = triangle.across[with_next ? top : last];
        return beyond < 0 || !farther(std::uint32_t(beyond), v[top]);
    }
    return std::none_of(ring.begin() + ring_start[v[top]], ring.begin() + ring_start[v[top] + 1],
                        [&](std::uint32_t w) { return farther(w, v[top]); });
}

}  // namespace tumble
