#include "sim/geometry/feature_contact.h"

#include "sim/geometry/contact_area.h"

#include <algorithm>

namespace tumble {
namespace {

// A polygon with labels, edge i from vertex i to i + 1.
void label_polygon(const std::vector<Vec3>& corners, const std::vector<std::uint32_t>& vertex_labels,
                   std::vector<ClipVertex>& polygon) {
    polygon.clear();
    for (std::size_t i = 0; i < corners.size(); ++i)
        polygon.push_back({corners[i], vertex_labels[i], std::uint32_t(i)});
}

}  // namespace

void clip_to_prism(const std::vector<Vec3>& reference, const Vec3& normal, std::vector<ClipVertex>& polygon,
                   std::vector<ClipVertex>& spare) {
    for (std::size_t side = 0; side < reference.size() && !polygon.empty(); ++side) {
        const Vec3& from = reference[side];
        const Vec3 out = (reference[(side + 1) % reference.size()] - from).cross(normal);
        spare.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const ClipVertex &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
            const double dp = out.dot(p.position - from), dq = out.dot(q.position - from);
            if (dp <= 0.0) spare.push_back(p);
            if ((dp <= 0.0) == (dq <= 0.0)) continue;
            ClipVertex cut;
            cut.position = p.position + dp / (dp - dq) * (q.position - p.position);
            cut.feature = (std::uint64_t(1) << 40) | (std::uint64_t(p.edge) << 20) | side_label(std::uint32_t(side));
            // Leaving: the following edge runs along the side. Entering: it continues the cut edge.
            cut.edge = dp <= 0.0 ? side_label(std::uint32_t(side)) : p.edge;
            spare.push_back(cut);
        }
        polygon.swap(spare);
    }
}

void add_face_manifold(const ReferenceFace& reference, bool must_touch, const ManifoldSink& sink) {
    CollisionScratch& scratch = sink.scratch;
    const Vec3& normal = reference.normal;
    label_polygon(scratch.incident, scratch.labels, scratch.polygon);
    clip_to_prism(scratch.reference, normal, scratch.polygon, scratch.spare);
    const Vec3& origin = scratch.reference[0];
    const std::uint64_t base = face_feature(reference.on_b, reference.label);
    scratch.points.clear();
    const auto keep = [&](const Vec3& p, std::uint64_t feature) {
        const double separation = normal.dot(p - origin);
        if (separation > sink.margin) return;
        scratch.points.push_back({sink.frame.to_world(p - 0.5 * separation * normal), separation, base | feature});
    };
    for (const ClipVertex& v : scratch.polygon) keep(v.position, v.feature);
    if (scratch.points.empty() && must_touch) {
        // Rounding clipped a sliver away: the deepest vertex replaces it.
        std::size_t deepest = 0;
        for (std::size_t i = 1; i < scratch.incident.size(); ++i)
            if (normal.dot(scratch.incident[i]) < normal.dot(scratch.incident[deepest])) deepest = i;
        keep(scratch.incident[deepest], scratch.labels[deepest]);
    }
    if (scratch.points.empty()) return;
    Manifold m;
    m.normal = sink.frame.rotation * (reference.on_b ? Vec3(-normal) : normal);
    m.corners = reference.on_b ? Corners::of_a : Corners::of_b;
    keep_best_points(scratch.points, m, scratch.reduced);
    spread_pressure(contact_area(scratch.points, m.normal), m);
    sink.out.push_back(m);
}

void add_edge_manifold(const EdgeSegment& a, const EdgeSegment& b, const Vec3& normal, double separation,
                       const ManifoldSink& sink) {
    const Pose& frame = sink.frame;
    // Nearest points of two segments (Ericson 2005, "Real-Time Collision Detection", 5.1.9). Precondition: not
    // parallel.
    const Vec3 u = a.head - a.tail, v = b.head - b.tail, r = a.tail - b.tail;
    const double uu = u.dot(u), vv = v.dot(v), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
    const double s = std::clamp((uv * vr - ur * vv) / (uu * vv - uv * uv), 0.0, 1.0);
    const double t = std::clamp((uv * s + vr) / vv, 0.0, 1.0);
    Manifold m;
    m.normal = frame.rotation * normal;
    m.count = 1;
    m.points[0] = {frame.to_world(0.5 * (a.tail + s * u + b.tail + t * v)), separation,
                   (std::uint64_t(1) << 62) | (a.index << 24) | b.index};
    m.set_geometry(CrossingEdges{frame.rotation * u, frame.rotation * v});
    sink.out.push_back(m);
}

}  // namespace tumble
