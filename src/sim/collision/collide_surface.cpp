// Spheres and polyhedra against a triangle surface. Seams between triangles must not catch what slides over them:
// a contact on an edge or a corner counts only if no face next to it already speaks for it.
#include "sim/collision/feature_contact.h"
#include "sim/collision/separating_axis.h"

#include <algorithm>
#include <limits>

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

struct TriangleAxis {
    enum class Kind { none, triangle, face, edges };
    Kind kind = Kind::none;
    double separation = 0.0;
    std::uint32_t feature = 0;    // face or edge of the polyhedron
    int edge = 0;                 // of the triangle
    Vec3 normal = Vec3::Zero();   // away from the triangle
};

// All in the polyhedron's frame: t are the triangle's corners, n its normal on the body's side.
TriangleAxis find_triangle_axis(const Polyhedron& shape, const Vec3 (&t)[3], const Vec3& n, double margin) {
    const auto triangle_reach = [&](const Vec3& d) { return std::max({d.dot(t[0]), d.dot(t[1]), d.dot(t[2])}); };
    TriangleAxis axis;
    axis.separation = n.dot(shape.vertices[shape.support(-n)]) - n.dot(t[0]);
    if (axis.separation > margin) return axis;
    axis.kind = TriangleAxis::Kind::triangle;
    axis.normal = n;
    double best = axis.separation + axis_preference(shape.radius);
    for (std::uint32_t f = 0; f < shape.faces.size(); ++f) {
        const Polyhedron::Face& face = shape.faces[f];
        const double separation = -triangle_reach(-face.normal) - face.offset;
        if (separation > margin) return {};
        if (separation <= best) continue;
        best = separation;
        axis = {TriangleAxis::Kind::face, separation, f, 0, -face.normal};
    }
    Bounds region;
    for (const Vec3& corner : t) region.add(corner);
    region = region.grown(margin);
    for (std::uint32_t e = 0; e < shape.edges.size(); ++e) {
        const Vec3 &tail = shape.vertices[shape.edges[e].tail], &head = shape.vertices[shape.edges[e].head];
        Bounds b;
        b.add(tail);
        b.add(head);
        if (!b.overlaps(region)) continue;
        const Vec3 along = head - tail;
        for (int i = 0; i < 3; ++i) {
            const Vec3 side = t[(i + 1) % 3] - t[i];
            Vec3 m = side.cross(along);
            const double square = m.squaredNorm();
            if (square < 1e-8 * side.squaredNorm() * along.squaredNorm()) continue;
            m /= std::sqrt(square);
            // Out of the triangle and into the body: the edge must be the body's extreme one that way.
            for (const double sign : {1.0, -1.0}) {
                const Vec3 out = sign * m;
                const double body = out.dot(shape.vertices[shape.support(-out)]);
                if (out.dot(tail) > body + 1e-9 * shape.radius) continue;
                const double separation = body - triangle_reach(out);
                if (separation > margin) return {};
                if (separation <= best || out.dot(t[i]) < triangle_reach(out) - 1e-9 * shape.radius) continue;
                best = separation;
                axis = {TriangleAxis::Kind::edges, separation, e, i, out};
            }
        }
    }
    return axis;
}

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
    // Faces first, then edges, then corners; each silences the features at its border.
    std::sort(hits.begin(), hits.end(), [](const auto& l, const auto& r) {
        const int kind_l = (l.feature + 2) / 3, kind_r = (r.feature + 2) / 3;
        if (kind_l != kind_r) return kind_l < kind_r;
        if (l.distance != r.distance) return l.distance < r.distance;
        return l.triangle < r.triangle;
    });
    auto &edges = scratch.used_edges, &vertices = scratch.used_vertices;
    edges.clear();
    vertices.clear();
    for (const auto& hit : hits) {
        const TriangleSurface::Triangle& t = a.triangles[hit.triangle];
        if (hit.feature >= 4) {
            const std::uint32_t v = t.vertices[std::size_t(hit.feature - 4)];
            if (contains(vertices, v)) continue;
            vertices.push_back(v);
        } else if (hit.feature >= 1) {
            const auto i = std::size_t(hit.feature - 1);
            if (contains(edges, t.edge[i])) continue;
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

void collide_surface_polyhedron(const TriangleSurface& a, const Pose& pose_a, const Polyhedron& b, const Pose& pose_b,
                                double margin, CollisionScratch& scratch, std::vector<Manifold>& out) {
    // In the body's frame: hulls are larger than triangles.
    const Pose a_in_b{pose_b.to_body(pose_a.position), pose_b.rotation.transpose() * pose_a.rotation};
    Bounds region;
    {
        const Vec3 center = a_in_b.rotation.transpose() * (b.bounds.center() - a_in_b.position);
        const Vec3 half = a_in_b.rotation.transpose().cwiseAbs() * (0.5 * b.bounds.extent());
        region = Bounds{center - half, center + half}.grown(margin);
    }
    auto& candidates = scratch.vertices;
    candidates.clear();
    a.tree.query(region, [&](std::uint32_t t) { candidates.push_back(t); });
    std::sort(candidates.begin(), candidates.end());
    for (const std::uint32_t index : candidates) {
        const TriangleSurface::Triangle& triangle = a.triangles[index];
        Vec3 t[3];
        for (int i = 0; i < 3; ++i) t[i] = a_in_b.to_world(a.corner(index, i));
        Vec3 n = a_in_b.rotation * triangle.normal;
        double side = 1.0;
        if (n.dot(t[0]) > 0.0) {   // the body's centre, its origin, lies behind
            if (a.closed) continue;
            side = -1.0;
            n = -n;
        }
        TriangleAxis axis = find_triangle_axis(b, t, n, margin);
        if (axis.kind == TriangleAxis::Kind::none) continue;
        if (axis.kind != TriangleAxis::Kind::triangle &&
            !a.owns_normal(triangle, a_in_b.rotation.transpose() * axis.normal, side)) {
            axis.kind = TriangleAxis::Kind::triangle;
            axis.normal = n;
        }
        const std::size_t first = out.size();
        if (axis.kind == TriangleAxis::Kind::edges) {
            const Polyhedron::Edge& e = b.edges[axis.feature];
            add_edge_manifold(t[axis.edge], t[(axis.edge + 1) % 3], b.vertices[e.tail], b.vertices[e.head], axis.normal,
                              axis.separation, std::uint64_t(axis.edge), axis.feature, pose_b, out);
        } else {
            const bool on_body = axis.kind == TriangleAxis::Kind::face;
            const std::uint32_t face = on_body ? axis.feature : b.face_at_support(-n, axis_preference(b.radius));
            std::vector<Vec3>& of_triangle = on_body ? scratch.incident : scratch.reference;
            std::vector<Vec3>& of_body = on_body ? scratch.reference : scratch.incident;
            of_triangle.assign(t, t + 3);
            if (side < 0.0) std::swap(of_triangle[1], of_triangle[2]);   // counter-clockwise about n
            of_body.clear();
            for (const std::uint32_t v : b.faces[face].vertices) of_body.push_back(b.vertices[v]);
            if (on_body) scratch.labels.assign({0u, 1u, 2u});
            else scratch.labels = b.faces[face].vertices;
            // The manifold's A is the triangle: its normal, or against the body's face.
            add_face_manifold(on_body ? Vec3(-axis.normal) : n, on_body ? face : 0, on_body, pose_b, margin, false, scratch, out);
        }
        for (std::size_t i = first; i < out.size(); ++i) out[i].part = index;
    }
}

}  // namespace tumble
