// Curved bodies against every other shape: the axis selects the features, and the features give the manifold.
#include "sim/geometry/curved_manifold.h"
#include "sim/geometry/separating_axis.h"
#include "sim/geometry/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool rounded(const ConvexShape& shape) { return shape.corner_count == 1 || (shape.curved && shape.curved->ellipsoid); }

/// Separation (m) by which another axis must exceed a face or a disc: none where it would show as an error of a round
/// surface.
double preference_of(const ConvexShape& a, const ConvexShape& b, AxisChoice choice) {
    return axis_preference(std::min(a.size, b.size), rounded(a) || rounded(b) ? AxisChoice::nearest : choice);
}

void add_flat(const ConvexShape& a, const ConvexShape& b, const CurvedAxis& axis, const ManifoldSink& sink) {
    const Vec3& n = axis.normal;
    const double level = sink.margin - std::min(0.0, axis.separation);
    std::vector<ClipVertex>& corners = sink.scratch.polygon;
    if (axis.kind == CurvedAxis::Kind::face_a) {
        // Only one of them has a polygon: with a polyhedron or a triangle the other is a curved body.
        const ContactFeature other = feature_along(b, -n, level, corners);
        return add_curved_manifold(face_feature_of(a, axis.feature, n, corners), other, n, false, sink);
    }
    ContactFeature other = feature_along(a, n, level, corners);
    if (a.hull)
        other = face_feature_of(
            a, a.hull->face_at_support(a.pose.rotation.transpose() * n, axis_preference(std::min(a.size, b.size))), n,
            corners);
    if (a.corner_count == 3) other = face_feature_of(a, 0, n, corners);
    add_curved_manifold(other, face_feature_of(b, axis.feature, -n, corners), n, true, sink);
}

void add_other(const ConvexShape& a, const ConvexShape& b, const Vec3& n, const ManifoldSink& sink) {
    const double level = axis_preference(std::min(a.size, b.size), sink.scratch.choice);
    std::vector<ClipVertex>& corners = sink.scratch.polygon;
    ContactFeature of_a = feature_along(a, n, level, corners), of_b = feature_along(b, -n, level, corners);
    // Beside a disc its rim: the axis is not that of the disc.
    for (ContactFeature* f : {&of_a, &of_b}) {
        if (f->kind != ContactFeature::Kind::disc) continue;
        f->kind = ContactFeature::Kind::point;
        f->ends[0] = f->shape->support(f->outward);
    }
    add_curved_manifold(of_a, of_b, n, false, sink);
}

// The normal of the pair's last manifold in the frame of the search; zero without one.
Vec3 last_normal(const CollisionScratch& scratch, const Pose& frame) {
    const auto found = std::find_if(scratch.before.begin(), scratch.before.end(),
                                    [&](const Manifold& m) { return m.part == scratch.part; });
    return found == scratch.before.end() ? Vec3(Vec3::Zero()) : Vec3(frame.rotation.transpose() * found->normal);
}

// True if one of the manifold's points is as near as `seen` (m).
bool reaches(const Manifold& m, double seen) {
    return std::any_of(m.points.begin(), m.points.begin() + m.count,
                       [&](const ContactPoint& p) { return p.separation <= seen; });
}

void collide_convex(const ConvexShape& a, const ConvexShape& b, const Pose& frame, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    CurvedAxisSearch search(a, b);
    if (!search.find_flat(query.margin, last_normal(scratch, frame))) {
        scratch.gap = search.gap();
        return;
    }
    const ManifoldSink sink{frame, query.margin, scratch, query.out};
    const double preference = preference_of(a, b, scratch.choice);
    const bool of_b =
        search.flat(true).separation > search.flat(false).separation + (scratch.was_on_b() ? -preference : preference);
    const CurvedAxis& flat = search.flat(of_b);
    const std::size_t first = query.out.size();
    // A face whose nearest points lie over it: no axis is better.
    if (flat.separation >= search.separation(search.first()) - preference) {
        add_flat(a, b, flat, sink);
        const double rounding = axis_preference(std::min(a.size, b.size), AxisChoice::nearest);
        if (query.out.size() > first && reaches(query.out[first], flat.separation + rounding)) return;
        query.out.resize(first);
    }
    const CurvedAxis best = search.find_best();
    if (best.separation > query.margin) {
        scratch.gap = best.separation;
        return;
    }
    if (flat.separation >= best.separation - preference) {
        add_flat(a, b, flat, sink);
        // Without a point where the shapes are nearest, the face's border is there.
        if (query.out.size() > first && reaches(query.out[first], best.separation + preference)) return;
        query.out.resize(first);
    }
    add_other(a, b, best.normal, sink);
}

bool apart(const CollisionQuery& query, double radii) {
    const double reach = radii + query.margin, square = (query.pose_b.position - query.pose_a.position).squaredNorm();
    if (square <= reach * reach) return false;
    query.scratch.gap = std::sqrt(square) - radii;
    return true;
}

}  // namespace

void collide_pair(const HalfSpace& a, const CurvedBody& b, const CollisionQuery& query) {
    const Vec3 normal = query.pose_a.rotation * a.normal;
    const double height = normal.dot(query.pose_b.position - query.pose_a.position) - a.offset;
    const double separation = height - b.extent(query.pose_b.rotation.transpose() * -normal);
    if (separation > query.margin) return;
    const Pose frame{query.pose_b.position, Mat3::Identity()};
    const ConvexShape shape = convex_shape(b, {Vec3::Zero(), query.pose_b.rotation});
    ContactFeature plane;
    plane.kind = ContactFeature::Kind::plane;
    plane.outward = plane.normal = normal;
    plane.origin = -height * normal;
    const double level = query.margin - std::min(0.0, separation);
    const ContactFeature other = feature_along(shape, -normal, level, query.scratch.polygon);
    add_curved_manifold(plane, other, normal, false, {frame, query.margin, query.scratch, query.out});
}

void collide_pair(const Ball& a, const CurvedBody& b, const CollisionQuery& query) {
    if (apart(query, a.radius + b.radius)) return;
    const Pose a_in_b = seen_from(query.pose_b, query.pose_a);
    collide_convex(convex_shape(a, a_in_b), convex_shape(b, Pose()), query.pose_b, query);
}

void collide_pair(const Polyhedron& a, const CurvedBody& b, const CollisionQuery& query) {
    if (apart(query, a.radius + b.radius)) return;
    const Pose b_in_a = seen_from(query.pose_a, query.pose_b);
    collide_convex(convex_shape(a, Pose()), convex_shape(b, b_in_a), query.pose_a, query);
}

void collide_pair(const CurvedBody& a, const CurvedBody& b, const CollisionQuery& query) {
    if (apart(query, a.radius + b.radius)) return;
    const Pose b_in_a = seen_from(query.pose_a, query.pose_b);
    collide_convex(convex_shape(a, Pose()), convex_shape(b, b_in_a), query.pose_a, query);
}

void collide_pair(const CollisionMesh& a, const CurvedBody& b, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    const Pose a_in_b = seen_from(query.pose_b, query.pose_a), b_in_a = seen_from(query.pose_a, query.pose_b);
    auto& candidates = scratch.vertices;
    candidates.clear();
    a.tree.query(b.world_bounds(b_in_a).grown(query.margin), [&](std::uint32_t t) { candidates.push_back(t); });
    std::sort(candidates.begin(), candidates.end());
    find_sides(a, candidates, b_in_a.position, scratch.sides);
    const ConvexShape body = convex_shape(b, Pose());
    const ManifoldSink sink{query.pose_b, query.margin, scratch, query.out};
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::uint32_t index = candidates[k];
        const CollisionMesh::Triangle& triangle = a.triangles[index];
        const bool behind = scratch.sides.behind[k] != 0;
        if (behind && a.closed) continue;
        std::array<Vec3, 3> corners;
        for (int i = 0; i < 3; ++i) corners[std::size_t(i)] = a_in_b.to_world(a.corner(index, i));
        const Vec3 normal = a_in_b.rotation * (behind ? Vec3(-triangle.normal) : triangle.normal);
        const ConvexShape piece = convex_triangle(corners, normal);
        CurvedAxisSearch search(piece, body);
        if (!search.find_flat(query.margin)) continue;
        const CurvedAxis best = search.find_best();
        if (best.separation > query.margin) continue;
        const double preference = preference_of(body, body, scratch.choice);
        const CurvedAxis &own = search.flat(false), &disc = search.flat(true);
        const auto owned = [&](const Vec3& n) { return a.owns_normal(triangle, a_in_b.rotation.transpose() * n); };
        const std::size_t first = query.out.size();
        if (own.separation >= best.separation - preference || !owned(best.normal))
            add_flat(piece, body, own, sink);
        else if (disc.separation >= best.separation - preference)
            add_flat(piece, body, disc, sink);
        else
            add_other(piece, body, best.normal, sink);
        if (query.out.size() > first) query.out[first].part = index;
    }
}

}  // namespace tumble
