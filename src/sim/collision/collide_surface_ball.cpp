// Spheres against a triangle surface. Seams between triangles must not catch what slides over them: a point on an edge or
// a corner counts only if the surface comes no nearer next to it.
#include "sim/collision/collide.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

struct Nearest {
    Vec3 point;
    int feature;   // 0 face, 1 to 3 edge, 4 to 6 vertex
};

// Nearest point of a triangle with the feature it lies on (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
Nearest nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0.0 && d2 <= 0.0) return {a, 4};
    if (d3 >= 0.0 && d4 <= d3) return {b, 5};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + d1 / (d1 - d3) * ab, 1};
    if (d6 >= 0.0 && d5 <= d6) return {c, 6};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + d2 / (d2 - d6) * ac, 3};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 2};
    const double scale = 1.0 / (va + vb + vc);
    return {a + vb * scale * ab + vc * scale * ac, 0};
}

template <class T>
bool contains(const std::vector<T>& list, T value) { return std::find(list.begin(), list.end(), value) != list.end(); }

}  // namespace

void collide_surface_ball(const TriangleSurface& a, const Pose& pose_a, const Ball& b, const Pose& pose_b,
                          double margin, CollisionScratch& scratch, std::vector<Manifold>& out) {
    const Vec3 center = pose_a.to_body(pose_b.position);
    const double reach = b.radius + margin;
    auto& hits = scratch.hits;
    hits.clear();
    a.tree.query(Bounds{center, center}.grown(reach), [&](std::uint32_t t) {
        const Nearest near = nearest_on_triangle(center, a.corner(t, 0), a.corner(t, 1), a.corner(t, 2));
        const double distance = (center - near.point).norm();
        if (distance > reach) return;
        const bool behind = a.triangles[t].normal.dot(center - near.point) < 0.0;
        if (behind && a.closed) return;
        hits.push_back({distance, t, near.feature, near.point});
    });
    // The least distance of the triangles at each edge and corner, first in its group after sorting.
    auto &at_edges = scratch.at_edges, &at_vertices = scratch.at_vertices;
    at_edges.clear();
    at_vertices.clear();
    for (const auto& hit : hits)
        for (const std::size_t i : {0u, 1u, 2u}) {
            at_edges.emplace_back(a.triangles[hit.triangle].edge[i], hit.distance);
            at_vertices.emplace_back(a.triangles[hit.triangle].vertices[i], hit.distance);
        }
    std::sort(at_edges.begin(), at_edges.end());
    std::sort(at_vertices.begin(), at_vertices.end());
    const auto least = [](const auto& list, std::uint32_t id) {
        return std::lower_bound(list.begin(), list.end(), std::make_pair(id, 0.0))->second;
    };
    // Faces first, then edges, then corners; each silences the features at its border. Ties go to the lower triangle.
    std::sort(hits.begin(), hits.end(), [](const auto& l, const auto& r) {
        const int kind_l = (l.feature + 2) / 3, kind_r = (r.feature + 2) / 3;
        return kind_l != kind_r ? kind_l < kind_r : l.triangle < r.triangle;
    });
    const double tie = 1e-10 * b.radius;
    auto &edges = scratch.used_edges, &vertices = scratch.used_vertices;
    edges.clear();
    vertices.clear();
    for (const auto& hit : hits) {
        const TriangleSurface::Triangle& t = a.triangles[hit.triangle];
        if (hit.feature >= 4) {
            const std::uint32_t v = t.vertices[std::size_t(hit.feature - 4)];
            if (contains(vertices, v) || hit.distance > least(at_vertices, v) + tie) continue;
            vertices.push_back(v);
        } else if (hit.feature >= 1) {
            const auto i = std::size_t(hit.feature - 1);
            if (contains(edges, t.edge[i]) || hit.distance > least(at_edges, t.edge[i]) + tie) continue;
            edges.push_back(t.edge[i]);
            vertices.insert(vertices.end(), {t.vertices[i], t.vertices[(i + 1) % 3]});
        } else {
            edges.insert(edges.end(), t.edge.begin(), t.edge.end());
            vertices.insert(vertices.end(), t.vertices.begin(), t.vertices.end());
        }
        Vec3 normal = t.normal;
        if (hit.distance > 1e-12 * b.radius && hit.feature != 0) normal = (center - hit.point) / hit.distance;
        else if (!a.closed && t.normal.dot(center - hit.point) < 0.0) normal = -normal;
        const double separation = hit.distance - b.radius;
        Manifold m;
        m.part = hit.triangle;
        m.normal = pose_a.rotation * normal;
        m.count = 1;
        m.points[0] = {pose_a.to_world(hit.point) + 0.5 * separation * m.normal, separation, std::uint64_t(hit.feature)};
        out.push_back(m);
    }
}

}  // namespace tumble
