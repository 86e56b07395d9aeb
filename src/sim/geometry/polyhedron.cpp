#include "sim/geometry/polyhedron.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tumble {

void Polyhedron::complete() {
    edges.clear();
    bounds = {};
    radius = 0.0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edge_of;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        Face& face = faces[f];
        // Newell's normal: exact for a plane polygon, the best fit for one that rounding has bent.
        Vec3 normal = Vec3::Zero(), center = Vec3::Zero();
        const std::size_t n = face.vertices.size();
        const Vec3& first = vertices[face.vertices[0]];
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 a = vertices[face.vertices[i]] - first, b = vertices[face.vertices[(i + 1) % n]] - first;
            normal += a.cross(b);
            center += vertices[face.vertices[i]];
        }
        face.normal = normal.normalized();
        face.offset = face.normal.dot(center) / double(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t a = face.vertices[i], b = face.vertices[(i + 1) % n];
            const auto key = std::minmax(a, b);
            const auto found = edge_of.find(key);
            if (found == edge_of.end()) {
                edge_of.emplace(key, edges.size());
                edges.push_back({a, b, std::uint32_t(f), std::uint32_t(f)});
            } else {
                edges[found->second].right = std::uint32_t(f);
            }
        }
    }
    for (const Vec3& v : vertices) {
        bounds.add(v);
        radius = std::max(radius, v.norm());
    }
    inner_radius = radius;
    for (const Face& face : faces) inner_radius = std::max(0.0, std::min(inner_radius, face.offset));

    std::vector<Bounds> edge_bounds(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        edge_bounds[e].add(vertices[edges[e].tail]);
        edge_bounds[e].add(vertices[edges[e].head]);
    }
    edge_tree = BoundsTree(std::move(edge_bounds));

    first_neighbor.assign(vertices.size() + 1, 0);
    for (const Edge& e : edges) ++first_neighbor[e.tail + 1], ++first_neighbor[e.head + 1];
    for (std::size_t i = 1; i < first_neighbor.size(); ++i) first_neighbor[i] += first_neighbor[i - 1];
    neighbors.resize(2 * edges.size());
    std::vector<std::uint32_t> next(first_neighbor.begin(), first_neighbor.end() - 1);
    for (const Edge& e : edges) {
        neighbors[next[e.tail]++] = e.head;
        neighbors[next[e.head]++] = e.tail;
    }
}

std::uint32_t Polyhedron::support(const Vec3& direction, std::uint32_t start) const {
    std::uint32_t best = start;
    double farthest = direction.dot(vertices[best]);
    while (true) {
        const std::uint32_t from = best;
        for (std::uint32_t k = first_neighbor[from]; k < first_neighbor[from + 1]; ++k) {
            const double d = direction.dot(vertices[neighbors[k]]);
            if (d > farthest) {
                farthest = d;
                best = neighbors[k];
            }
        }
        if (best == from) return best;
    }
}

std::uint32_t Polyhedron::face_at_support(const Vec3& direction, double depth) const {
    const std::uint32_t farthest = support(direction);
    const double level = direction.dot(vertices[farthest]) - depth;
    std::uint32_t best = 0;
    std::ptrdiff_t best_count = 0;
    double most = 0.0;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const std::vector<std::uint32_t>& loop = faces[i].vertices;
        if (std::find(loop.begin(), loop.end(), farthest) == loop.end()) continue;
        const auto count = std::count_if(loop.begin(), loop.end(),
                                         [&](std::uint32_t v) { return direction.dot(vertices[v]) >= level; });
        const double d = direction.dot(faces[i].normal);
        if (count > best_count || (count == best_count && d > most)) {
            best = i;
            best_count = count;
            most = d;
        }
    }
    return best;
}

double Polyhedron::surface_area() const {
    double area = 0.0;
    for (const Face& face : faces) {
        const Vec3& first = vertices[face.vertices[0]];
        for (std::size_t i = 2; i < face.vertices.size(); ++i) {
            const Vec3 a = vertices[face.vertices[i - 1]] - first, b = vertices[face.vertices[i]] - first;
            area += 0.5 * a.cross(b).norm();
        }
    }
    return area;
}

Polyhedron make_box(const Vec3& size) {
    Polyhedron p;
    const Vec3 h = 0.5 * size;
    // Vertex i has the signs of i's bits: bit 0 x, bit 1 y, bit 2 z.
    for (int i = 0; i < 8; ++i)
        p.vertices.emplace_back(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
    const std::uint32_t loops[6][4] = {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3},
                                       {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}};
    for (const auto& loop : loops) p.faces.push_back({Vec3::Zero(), 0.0, {loop, loop + 4}});
    p.complete();
    for (int f = 0; f < 6; ++f) {  // exact planes: no rounding from the normalization
        p.faces[f].normal = Vec3::Unit(f / 2) * (f % 2 ? -1.0 : 1.0);
        p.faces[f].offset = h[f / 2];
    }
    p.is_box = true;
    p.half_extent = h;
    return p;
}

}  // namespace tumble
