#include "sim/snapshot/measurement.h"

#include "sim/geometry/contact_tolerance.h"
#include "sim/geometry/shapes/shape.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace tumble {

Measurement measure_motion(const std::vector<Body>& bodies, const Vec3& gravity, const Vec3& origin) {
    Measurement m;
    for (const Body& body : bodies) {
        if (!body.dynamic()) continue;
        m.kinetic += body.kinetic_energy();
        m.kinetic_linear += 0.5 * body.momentum.dot(body.velocity);
        m.kinetic_angular += 0.5 * body.angular_momentum.dot(body.angular_velocity);
        const Vec3 place = origin + body.position;
        m.potential -= body.mass * body.fall(gravity).dot(place);
        m.momentum += body.momentum;
        m.angular_momentum += place.cross(body.momentum) + body.angular_momentum;
    }
    return m;
}

void measure_contacts(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies, Measurement& m) {
    for (const Manifold& manifold : manifolds) {
        const double touch = touch_distance(bodies[manifold.a].radius, bodies[manifold.b].radius);
        for (int i = 0; i < manifold.count; ++i) {
            const double separation = manifold.points[std::size_t(i)].separation;
            m.contacts += separation <= touch;
            m.max_penetration = std::max(m.max_penetration, -separation);
        }
    }
}

std::vector<Overlap> overlaps_of(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies,
                                 std::span<const std::uint32_t> scene_index) {
    std::map<std::pair<std::size_t, std::size_t>, Overlap> by_pair;  // a pair of several parts has several manifolds
    for (const Manifold& m : manifolds) {
        const auto [a, b] = std::minmax({std::size_t(scene_index[m.a]), std::size_t(scene_index[m.b])});
        for (int i = 0; i < m.count; ++i) {
            const double deep = -m.points[std::size_t(i)].separation;
            if (!(deep > 0.0)) continue;
            Overlap& overlap = by_pair[{a, b}];
            const double thickness = 2.0 * std::min(depth(bodies[m.a].collider), depth(bodies[m.b].collider));
            overlap = {a, b, std::max(overlap.depth, deep), std::max(overlap.share, deep / thickness)};
        }
    }
    std::vector<Overlap> overlaps;
    for (const auto& [pair, overlap] : by_pair) overlaps.push_back(overlap);
    return overlaps;
}

BodyReport describe(const Body& body) {
    BodyReport r;
    r.mass = body.dynamic() ? body.mass : std::numeric_limits<double>::infinity();
    if (body.dynamic()) r.principal_inertia = Eigen::SelfAdjointEigenSolver<Mat3>(body.inertia_body).eigenvalues();
    if (body.dynamic()) r.inertia = body.inertia_body;
    r.center_of_mass = body.center_of_mass;
    const auto add = [&](const CollisionShape& collider) {
        if (contact_surface(collider) == ContactSurface::polyhedral)
            r.hull_vertices += rounded_hull(collider).points.size();
    };
    add(body.collider);
    if (contact_surface(body.collider) == ContactSurface::triangles) r.triangles = part_count(body.collider);
    if (const auto* compound = std::get_if<std::shared_ptr<const Compound>>(&body.collider))
        for (const Compound::Part& part : (*compound)->parts) add(part.collider);
    return r;
}

}  // namespace tumble
