// Polyhedra against a triangle mesh, triangle by triangle. Internal edges must not catch a sliding body: a normal that
// leans over the border of a triangle counts only if the mesh owns it there; otherwise the triangle's own normal
// replaces it.
#include "sim/geometry/feature_contact.h"
#include "sim/geometry/separating_axis.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// A triangle in the polyhedron's frame.
struct FacingTriangle {
    Vec3 corners[3];
    Vec3 normal;          // on the body's side
    bool behind = false;  // the body is on the other side than the triangle's own normal
};

struct TriangleAxis {
    enum class Kind { none, triangle, face, edges };
    Kind kind = Kind::none;
    double separation = 0.0;
    std::uint32_t feature = 0;   // index of a face or edge of the polyhedron
    int edge = 0;                // index of an edge of the triangle
    Vec3 normal = Vec3::Zero();  // away from the triangle
};

// True if a direction lies on the arc between the normals of an edge's two faces, so that the edge is the farthest
// feature along it. Precondition: the direction is perpendicular to the edge.
bool on_arc(const Vec3& direction, const Vec3& left, const Vec3& right) {
    const Vec3 turn = left.cross(right);
    return left.cross(direction).dot(turn) >= 0.0 && direction.cross(right).dot(turn) >= 0.0 &&
           direction.dot(left + right) > 0.0;
}

TriangleAxis find_triangle_axis(const Polyhedron& shape, const FacingTriangle& triangle, double margin,
                                EdgeSearch search, CollisionScratch& scratch) {
    const auto& t = triangle.corners;
    const Vec3& n = triangle.normal;
    std::vector<std::uint32_t>& edges = scratch.edges_b;
    const auto triangle_reach = [&](const Vec3& d) { return std::max({d.dot(t[0]), d.dot(t[1]), d.dot(t[2])}); };
    TriangleAxis axis;
    axis.separation = n.dot(shape.vertices[shape.support(-n)]) - n.dot(t[0]);
    if (axis.separation > margin) return axis;
    axis.kind = TriangleAxis::Kind::triangle;
    axis.normal = n;
    double best = axis.separation + axis_preference(shape.radius, scratch.choice);
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    for (std::uint32_t f = 0; f < shape.faces.size(); ++f) {
        const Polyhedron::Face& face = shape.faces[f];
        if (face.normal.dot(middle) - face.offset <= best) continue;  // the lowest corner is not above the middle
        const double separation = -triangle_reach(-face.normal) - face.offset;
        if (separation > margin) return {};
        if (separation <= best) continue;
        best = separation;
        axis = {TriangleAxis::Kind::face, separation, f, 0, -face.normal};
    }
    // For an edge that lies in a face, the edge pair gives the face's separation to rounding, and would leave one point
    // of two.
    best = std::max(best, axis.separation + axis_preference(shape.radius, scratch.choice));
    Bounds region;
    for (const Vec3& corner : t) region.add(corner);
    region = region.grown(edge_reach(search, margin, axis.separation));
    edges.clear();
    shape.edge_tree.query(region, [&](std::uint32_t e) { edges.push_back(e); });
    std::sort(edges.begin(), edges.end());
    for (const std::uint32_t e : edges) {
        const Polyhedron::Edge& edge = shape.edges[e];
        const Vec3 &tail = shape.vertices[edge.tail], &head = shape.vertices[edge.head];
        const Vec3 along = head - tail, &left = shape.faces[edge.left].normal, &right = shape.faces[edge.right].normal;
        for (int i = 0; i < 3; ++i) {
            const Vec3 side = t[(i + 1) % 3] - t[i];
            Vec3 m = side.cross(along);
            const double square = m.squaredNorm();
            if (square < 1e-8 * side.squaredNorm() * along.squaredNorm()) continue;
            m /= std::sqrt(square);
            if (m.dot(left + right) > 0.0) m = -m;  // out of the triangle, into the body
            if (!on_arc(-m, left, right)) continue;
            const double reach = triangle_reach(m), separation = m.dot(tail) - reach;
            if (separation > margin) return {};
            if (separation <= best || m.dot(t[i]) < reach - 1e-9 * shape.radius) continue;
            best = separation;
            axis = {TriangleAxis::Kind::edges, separation, e, i, m};
        }
    }
    return axis;
}

// The sink's frame is that of the polyhedron.
void add_triangle_manifold(const Polyhedron& b, const FacingTriangle& triangle, const TriangleAxis& axis,
                           const ManifoldSink& sink) {
    CollisionScratch& scratch = sink.scratch;
    const auto& t = triangle.corners;
    const Vec3& n = triangle.normal;
    if (axis.kind == TriangleAxis::Kind::edges) {
        const Polyhedron::Edge& e = b.edges[axis.feature];
        add_edge_manifold({t[axis.edge], t[(axis.edge + 1) % 3], std::uint64_t(axis.edge)},
                          {b.vertices[e.tail], b.vertices[e.head], axis.feature}, axis.normal, axis.separation, sink);
        return;
    }
    const bool on_body = axis.kind == TriangleAxis::Kind::face;
    const std::uint32_t face = on_body ? axis.feature : b.face_at_support(-n, axis_preference(b.radius));
    std::vector<Vec3>& of_triangle = on_body ? scratch.incident : scratch.reference;
    std::vector<Vec3>& of_body = on_body ? scratch.reference : scratch.incident;
    of_triangle.assign(t, t + 3);
    if (triangle.behind) std::swap(of_triangle[1], of_triangle[2]);  // counter-clockwise about n
    of_body.clear();
    for (const std::uint32_t v : b.faces[face].vertices) of_body.push_back(b.vertices[v]);
    if (on_body)
        scratch.labels.assign({0u, 1u, 2u});
    else
        scratch.labels = b.faces[face].vertices;
    // The manifold's A is the triangle. Normal: that of the triangle, or opposite to that of the body's face.
    add_face_manifold({on_body ? Vec3(-axis.normal) : n, on_body ? face : 0, on_body}, false, sink);
}

// True if a contact point of the triangle lies in the body: proof of an overlap.
bool proves_overlap(const Manifold& m, const Polyhedron& shape, const Pose& pose) {
    return std::any_of(m.points.begin(), m.points.begin() + m.count, [&](const ContactPoint& p) {
        const Vec3 on_triangle = pose.to_body(p.position - 0.5 * p.separation * m.normal);
        return shape.contains(on_triangle, axis_preference(shape.radius));
    });
}

}  // namespace

void collide_pair(const CollisionMesh& a, const Polyhedron& b, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    // In the body's frame, because hulls are larger than triangles.
    const Pose a_in_b = seen_from(query.pose_b, query.pose_a);
    Bounds region;
    {
        const Vec3 center = a_in_b.rotation.transpose() * (b.bounds.center() - a_in_b.position);
        const Vec3 half = a_in_b.rotation.transpose().cwiseAbs() * (0.5 * b.bounds.extent());
        region = Bounds{center - half, center + half}.grown(query.margin);
    }
    auto& candidates = scratch.vertices;
    candidates.clear();
    a.tree.query(region, [&](std::uint32_t t) { candidates.push_back(t); });
    std::sort(candidates.begin(), candidates.end());
    // The origin of this frame is the body's center.
    find_sides(a, candidates, a_in_b.rotation.transpose() * -a_in_b.position, scratch.sides);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::uint32_t index = candidates[k];
        const CollisionMesh::Triangle& triangle = a.triangles[index];
        FacingTriangle facing;
        facing.behind = scratch.sides.behind[k] != 0;
        if (facing.behind && a.closed) continue;
        for (int i = 0; i < 3; ++i) facing.corners[i] = a_in_b.to_world(a.corner(index, i));
        facing.normal = a_in_b.rotation * triangle.normal;
        if (facing.behind) facing.normal = -facing.normal;
        for (const EdgeSearch search : {EdgeSearch::nearby, EdgeSearch::all}) {
            TriangleAxis axis = find_triangle_axis(b, facing, query.margin, search, scratch);
            if (axis.kind == TriangleAxis::Kind::none) break;
            if (axis.kind != TriangleAxis::Kind::triangle &&
                !a.owns_normal(triangle, a_in_b.rotation.transpose() * axis.normal)) {
                axis.kind = TriangleAxis::Kind::triangle;
                axis.normal = facing.normal;
            }
            const std::size_t first = query.out.size();
            add_triangle_manifold(b, facing, axis, {query.pose_b, query.margin, scratch, query.out});
            if (query.out.size() == first) break;
            query.out[first].part = index;
            if (search == EdgeSearch::all || axis.separation >= 0.0 ||
                proves_overlap(query.out[first], b, query.pose_b))
                break;
            query.out.resize(first);  // rare: see EdgeSearch
        }
    }
}

}  // namespace tumble
