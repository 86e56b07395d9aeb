// Polyhedron against polyhedron: the separating axis selects the features, and the features give the manifold.
#include "sim/geometry/feature_contact.h"
#include "sim/geometry/separating_axis.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

void corners(const Polyhedron& shape, std::uint32_t face, const Pose& pose, std::vector<Vec3>& out) {
    out.clear();
    for (const std::uint32_t v : shape.faces[face].vertices) out.push_back(pose.to_world(shape.vertices[v]));
}

EdgeSegment segment(const Polyhedron& shape, std::uint32_t edge, const Pose& pose) {
    const Polyhedron::Edge& e = shape.edges[edge];
    return {pose.to_world(shape.vertices[e.tail]), pose.to_world(shape.vertices[e.head]), edge};
}

void add_manifold(const Polyhedron& a, const Polyhedron& b, const Pose& b_in_a, const SeparatingAxis& axis,
                  bool overlapping, const ManifoldSink& sink) {
    CollisionScratch& scratch = sink.scratch;
    const Pose identity;
    const double level = axis_preference(std::min(a.radius, b.radius));
    switch (axis.kind) {
        case SeparatingAxis::Kind::none:
            return;
        case SeparatingAxis::Kind::face_a: {
            const std::uint32_t incident = b.face_at_support(-(b_in_a.rotation.transpose() * axis.normal), level);
            corners(a, axis.feature_a, identity, scratch.reference);
            corners(b, incident, b_in_a, scratch.incident);
            scratch.labels = b.faces[incident].vertices;
            add_face_manifold({axis.normal, axis.feature_a, false}, overlapping, sink);
            return;
        }
        case SeparatingAxis::Kind::face_b: {
            const std::uint32_t incident = a.face_at_support(axis.normal, level);
            corners(b, axis.feature_b, b_in_a, scratch.reference);
            corners(a, incident, identity, scratch.incident);
            scratch.labels = a.faces[incident].vertices;
            add_face_manifold({-axis.normal, axis.feature_b, true}, overlapping, sink);
            return;
        }
        case SeparatingAxis::Kind::edges: {
            const Polyhedron::Edge& ea = a.edges[axis.feature_a];
            add_edge_manifold({a.vertices[ea.tail], a.vertices[ea.head], axis.feature_a},
                              segment(b, axis.feature_b, b_in_a), axis.normal, axis.separation, sink);
            return;
        }
    }
}

// True if a contact point lies in both shapes: proof of an overlap.
bool proves_overlap(const Manifold& m, const Polyhedron& a, const Pose& pose_a, const Polyhedron& b,
                    const Pose& pose_b) {
    const double slack = axis_preference(std::min(a.radius, b.radius));
    return std::any_of(m.points.begin(), m.points.begin() + m.count, [&](const ContactPoint& p) {
        return a.contains(pose_a.to_body(p.position), slack) && b.contains(pose_b.to_body(p.position), slack);
    });
}

}  // namespace

void collide_pair(const Polyhedron& a, const Polyhedron& b, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    const double radii = a.radius + b.radius, reach = radii + query.margin,
                 square = (query.pose_b.position - query.pose_a.position).squaredNorm();
    if (square > reach * reach) {
        scratch.gap = std::sqrt(square) - radii;
        return;
    }
    if (a.is_box && b.is_box) return collide_boxes(a, b, query);
    // In A's frame, which keeps the digits of scenes far from the origin.
    const Pose b_in_a = seen_from(query.pose_a, query.pose_b);
    const std::size_t first = query.out.size();
    const ManifoldSink sink{query.pose_a, query.margin, scratch, query.out};
    const auto add = [&](EdgeSearch search) {  // returns whether the shapes seem to overlap
        SeparatingAxis edges;
        const SeparatingAxis axis = find_separating_axis(
            {a, b, b_in_a, query.margin, search, query.pose_a.rotation.transpose() * scratch.displacement}, scratch,
            &edges);
        const bool preferred = edges.kind == SeparatingAxis::Kind::edges,
                   overlapping = axis.separation < 0.0 && !axis.grazed;
        add_manifold(a, b, b_in_a, axis, overlapping && !preferred, sink);
        if (!preferred ||
            !misses_edges(std::span(query.out).subspan(first), edges.separation, std::min(a.radius, b.radius)))
            return overlapping;
        query.out.resize(first);
        add_manifold(a, b, b_in_a, edges, false, sink);
        return edges.separation < 0.0;
    };
    if (!add(EdgeSearch::nearby) || query.out.size() == first ||
        proves_overlap(query.out[first], a, query.pose_a, b, query.pose_b))
        return;
    // Rare: deep overlaps, and shapes separated along a pair of edges that the nearby search skipped.
    query.out.resize(first);
    add(EdgeSearch::all);
}

}  // namespace tumble
