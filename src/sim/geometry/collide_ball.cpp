// Spheres against half-spaces, spheres and polyhedra; half-spaces against polyhedra.
#include "sim/geometry/collide.h"
#include "sim/geometry/contact_area.h"
#include "sim/geometry/separating_axis.h"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

void add_point(const Vec3& normal, const Vec3& position, double separation, std::vector<Manifold>& out) {
    Manifold m;
    m.normal = normal;
    m.count = 1;
    m.points[0] = {position, separation, 0};
    out.push_back(m);
}

struct Nearest {
    Vec3 point = Vec3::Zero();
    bool inside = false;       // nearest point is inside the face; otherwise on its border
    Vec3 edge = Vec3::Zero();  // direction of the nearest edge; zero at a corner
};

// The point of a convex polygon nearest to p, where p lies on the outer side of its plane.
Nearest nearest_on_face(const Polyhedron& shape, const Polyhedron::Face& face, const Vec3& p) {
    const Vec3 foot = p - (face.normal.dot(p) - face.offset) * face.normal;
    double best = std::numeric_limits<double>::infinity();
    Nearest nearest{foot, true};
    const std::size_t n = face.vertices.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 &a = shape.vertices[face.vertices[i]], &b = shape.vertices[face.vertices[(i + 1) % n]];
        const Vec3 edge = b - a;
        if (edge.cross(face.normal).dot(foot - a) <= 0.0) continue;
        const double t = std::clamp(edge.dot(foot - a) / edge.squaredNorm(), 0.0, 1.0);
        const Vec3 candidate = a + t * edge;
        const double d = (candidate - p).squaredNorm();
        if (d < best) {
            best = d;
            nearest = {candidate, false, t > 0.0 && t < 1.0 ? Vec3(edge.normalized()) : Vec3(Vec3::Zero())};
        }
    }
    return nearest;
}

}  // namespace

void collide_pair(const HalfSpace& a, const Ball& b, const CollisionQuery& query) {
    const Vec3 normal = query.pose_a.rotation * a.normal;
    const double height = normal.dot(query.pose_b.position - query.pose_a.position) - a.offset;
    const double separation = height - b.radius;
    if (separation > query.margin) return;
    add_point(normal, query.pose_b.position - (b.radius + 0.5 * separation) * normal, separation, query.out);
    query.out.back().set_geometry(BallOverFace{false, query.pose_b.position});
}

void collide_pair(const Ball& a, const Ball& b, const CollisionQuery& query) {
    const Vec3 d = query.pose_b.position - query.pose_a.position;
    const double reach = a.radius + b.radius + query.margin;
    if (d.squaredNorm() > reach * reach) return;
    const double distance = d.norm();
    // Coincident centers, or so near that the squares underflow: any direction is as good.
    const Vec3 normal = distance > 1e-140 ? Vec3(d / distance) : Vec3::UnitY();
    const double separation = distance - a.radius - b.radius;
    add_point(normal, query.pose_a.position + (a.radius + 0.5 * separation) * normal, separation, query.out);
    query.out.back().set_geometry(CurvedGap{distance, Vec3::Zero(), query.pose_a.position, query.pose_b.position});
}

void collide_pair(const Polyhedron& a, const Ball& b, const CollisionQuery& query) {
    const Vec3 center = query.pose_a.to_body(query.pose_b.position);
    const double reach = b.radius + query.margin;
    // The face with the greatest distance from the center: a lower bound of the gap, and the direction of least
    // penetration when the center is inside.
    double most = -std::numeric_limits<double>::infinity();
    // some face even where the center is not a number: the end of the step reports that
    const Polyhedron::Face* face = a.faces.data();
    for (const Polyhedron::Face& f : a.faces) {
        const double d = f.normal.dot(center) - f.offset;
        if (d > reach) return;
        if (d > most) {
            most = d;
            face = &f;
        }
    }
    if (most <= 0.0) {
        const Vec3 normal = query.pose_a.rotation * face->normal;
        const double separation = most - b.radius;
        add_point(normal, query.pose_b.position - (b.radius + 0.5 * separation) * normal, separation, query.out);
        query.out.back().set_geometry(BallOverFace{false, query.pose_b.position});
        return;
    }
    // Only faces with the center on their outer side can hold the nearest point.
    double best = std::numeric_limits<double>::infinity();
    Nearest nearest;
    for (const Polyhedron::Face& f : a.faces) {
        const double d = f.normal.dot(center) - f.offset;
        if (d <= 0.0 || d * d >= best) continue;
        const Nearest candidate = nearest_on_face(a, f, center);
        const double square = candidate.inside ? d * d : (center - candidate.point).squaredNorm();
        if (square < best) {
            best = square;
            nearest = candidate;
            face = &f;
        }
    }
    const double distance = std::sqrt(best);
    if (distance > reach) return;
    // Over a face the normal is the face's own; on its border too when rounding leaves no direction.
    const bool of_face = nearest.inside || distance <= 1e-12 * a.radius;
    const Vec3 normal = query.pose_a.rotation * (of_face ? face->normal : Vec3((center - nearest.point) / distance));
    const double separation = distance - b.radius;
    const Vec3 point = query.pose_a.to_world(nearest.point);
    add_point(normal, point + 0.5 * separation * normal, separation, query.out);
    if (of_face)
        query.out.back().set_geometry(BallOverFace{false, query.pose_b.position});
    else
        query.out.back().set_geometry(
            CurvedGap{distance, query.pose_a.rotation * nearest.edge, point, query.pose_b.position});
}

void collide_pair(const HalfSpace& a, const Polyhedron& b, const CollisionQuery& query) {
    CollisionScratch& scratch = query.scratch;
    const Vec3 normal = query.pose_a.rotation * a.normal;
    const double height = normal.dot(query.pose_b.position - query.pose_a.position) - a.offset;
    if (height > b.radius + query.margin) return;
    const Vec3 local = query.pose_b.rotation.transpose() * normal;
    scratch.points.clear();
    const auto keep = [&](std::uint32_t i) {
        const double separation = height + local.dot(b.vertices[i]);
        if (separation <= query.margin)
            scratch.points.push_back({query.pose_b.to_world(b.vertices[i]) - 0.5 * separation * normal, separation, i});
    };
    for (std::uint32_t i = 0; i < b.vertices.size(); ++i) keep(i);
    if (scratch.points.empty()) return;
    if (scratch.turning && scratch.points.size() > Manifold::capacity) {
        // A rolling body keeps the points that it rolls on, not the points that span the largest area with them.
        scratch.points.clear();
        for (const std::uint32_t i : b.faces[b.face_at_support(-local, axis_preference(b.radius))].vertices) keep(i);
    }
    Manifold m;
    m.normal = normal;
    m.corners = Corners::of_b;
    keep_best_points(scratch.points, m, scratch.reduced);
    if (m.count > 1) {
        // All corners lie over the plane: the corners of the face along the plane bound the contact area.
        scratch.incident.clear();
        for (const std::uint32_t i : b.faces[b.face_at_support(-local, axis_preference(b.radius))].vertices)
            scratch.incident.push_back(query.pose_b.to_world(b.vertices[i]));
        spread_pressure(contact_area(scratch.incident, normal), m);
    }
    query.out.push_back(m);
}

}  // namespace tumble
