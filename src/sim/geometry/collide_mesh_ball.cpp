// Spheres against a triangle mesh. Internal edges must not catch a sliding sphere: a point on an edge or a corner
// counts only if the mesh comes no nearer next to it.
#include "sim/geometry/collide.h"
#include "sim/geometry/shapes/mesh.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

template <class T>
bool listed(const std::vector<T>& list, T value) {
    return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

void collide_pair(const CollisionMesh& a, const Ball& b, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    const Vec3 center = query.pose_a.to_body(query.pose_b.position);
    const double reach = b.radius + query.margin;
    auto& hits = scratch.hits;
    hits.clear();
    a.tree.query(Bounds{center, center}.grown(reach), [&](std::uint32_t t) {
        const NearestOnTriangle near = nearest_on_triangle(center, a.corner(t, 0), a.corner(t, 1), a.corner(t, 2));
        const double distance = (center - near.point).norm();
        if (distance > reach) return;
        const bool behind = a.triangles[t].normal.dot(center - near.point) < 0.0;
        if (behind && a.closed) return;
        hits.push_back({distance, t, near.feature, near.point});
    });
    // The least distance among the triangles at each edge and corner; first in its group after sorting.
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
    // Faces first, then edges, then corners; each suppresses the features at its border. Ties go to the lower triangle
    // index.
    std::sort(hits.begin(), hits.end(), [](const auto& l, const auto& r) {
        const int kind_l = (l.feature + 2) / 3, kind_r = (r.feature + 2) / 3;
        return kind_l != kind_r ? kind_l < kind_r : l.triangle < r.triangle;
    });
    const double tie = 1e-10 * b.radius;
    auto &edges = scratch.used_edges, &vertices = scratch.used_vertices;
    edges.clear();
    vertices.clear();
    for (const auto& hit : hits) {
        const CollisionMesh::Triangle& t = a.triangles[hit.triangle];
        if (hit.feature >= 4) {
            const std::uint32_t v = t.vertices[std::size_t(hit.feature - 4)];
            if (listed(vertices, v) || hit.distance > least(at_vertices, v) + tie) continue;
            vertices.push_back(v);
        } else if (hit.feature >= 1) {
            const auto i = std::size_t(hit.feature - 1);
            if (listed(edges, t.edge[i]) || hit.distance > least(at_edges, t.edge[i]) + tie) continue;
            edges.push_back(t.edge[i]);
            vertices.insert(vertices.end(), {t.vertices[i], t.vertices[(i + 1) % 3]});
        } else {
            edges.insert(edges.end(), t.edge.begin(), t.edge.end());
            vertices.insert(vertices.end(), t.vertices.begin(), t.vertices.end());
        }
        Vec3 normal = t.normal;
        if (hit.distance > 1e-12 * b.radius && hit.feature != 0)
            normal = (center - hit.point) / hit.distance;
        else if (!a.closed && t.normal.dot(center - hit.point) < 0.0)
            normal = -normal;
        const double separation = hit.distance - b.radius;
        Manifold m;
        m.part = hit.triangle;
        m.normal = query.pose_a.rotation * normal;
        m.count = 1;
        const Vec3 point = query.pose_a.to_world(hit.point);
        m.points[0] = {point + 0.5 * separation * m.normal, separation, std::uint64_t(hit.feature)};
        if (hit.feature != 0) {
            const auto corner = [&](int k) { return a.corner(hit.triangle, k); };
            const int k = hit.feature - 1;
            const Vec3 edge =
                hit.feature < 4 ? Vec3((corner((k + 1) % 3) - corner(k)).normalized()) : Vec3(Vec3::Zero());
            m.set_geometry(CurvedGap{hit.distance, query.pose_a.rotation * edge, point, query.pose_b.position});
        } else {
            m.set_geometry(BallOverFace{false, query.pose_b.position});
        }
        query.out.push_back(m);
    }
}

}  // namespace tumble
