#include "sim/contact/rolling/rolling_contact.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/model/rotational_friction.h"
#include "sim/geometry/contact_tolerance.h"

#include <algorithm>

namespace tumble {
namespace {

/// Deeper overlaps, radii, are left to the contact solver.
constexpr double deep_overlap = 0.05;

/// Share of an overlap that is lifted in a step, as by the solver: a jump would be seen.
constexpr double lifted_share = 0.2;

// The plane on which the manifold's points lie. Of a face only if the body cannot reach its border within the span.
std::optional<RollingPlane> plane_of(const Manifold& m, const Body& body, const Body& other, double span) {
    if (other.moves() || has_rotational_friction(other)) return {};
    const auto plane = [&](const Vec3& normal, double offset) {
        const Vec3 world = other.rotation * normal;
        return RollingPlane{world, offset + world.dot(other.position), pair_friction(body, other),
                            pair_restitution(body, other)};
    };
    if (const auto* space = std::get_if<HalfSpace>(&other.collider)) return plane(space->normal, space->offset);
    const auto* hull = std::get_if<std::shared_ptr<const Polyhedron>>(&other.collider);
    if (!hull) return {};
    const Vec3 place = other.pose().to_body(body.position);
    const Vec3 towards = other.rotation.transpose() * (body.position - m.points[0].position);
    const double reach = body.radius + span * body.velocity.norm();
    const Polyhedron::Face* below = nullptr;
    for (const Polyhedron::Face& face : (*hull)->faces) {
        const double height = face.normal.dot(place) - face.offset;
        if (height <= -reach) continue;
        if (below || !(face.normal.dot(towards) > 0.0)) return {};
        below = &face;
    }
    if (!below) return {};
    return plane(below->normal, below->offset);
}

Impulse momenta(const Vec3& position, const Vec3& momentum, const Vec3& angular_momentum) {
    return {momentum, position.cross(momentum) + angular_momentum};
}

}  // namespace

bool may_roll(const Body& body) {
    return std::holds_alternative<std::shared_ptr<const CurvedBody>>(body.collider) && !body.jointed &&
           !has_rotational_friction(body);
}

std::optional<RolledContact> roll_alone(std::uint32_t i, const std::vector<Body>& bodies,
                                        const std::vector<Manifold>& manifolds, std::span<const std::uint32_t> of_body,
                                        const ForceField& forces, const Vec3& gravity, double span) {
    if (!may_roll(bodies[i]) || !forces.only_gravity(i)) return {};
    Body body = bodies[i];
    RolledContact result;
    result.body = i;
    double gap = infinity, next = infinity, touch = 0.0;  // the two smallest gaps, of their excess over touching
    for (const std::uint32_t k : of_body) {
        const Manifold& m = manifolds[k];
        const double touching = touch_distance(body.radius, bodies[m.a == i ? m.b : m.a].radius);
        for (int p = 0; p < m.count; ++p) {
            const double separation = m.points[std::size_t(p)].separation;
            if (separation - touching >= gap - touch) {
                next = std::min(next, separation - touching);
                continue;
            }
            next = gap - touch;
            gap = separation;
            touch = touching;
            result.manifold = k;
            result.point = p;
        }
    }
    if (!(gap < infinity) || next <= 0.0 || gap < -deep_overlap * body.radius) return {};
    const Manifold& m = manifolds[result.manifold];
    const auto plane = plane_of(m, body, bodies[m.a == i ? m.b : m.a], span);
    if (!plane) return {};
    result.plane = *plane;
    body.derive();
    const double overlap = gap < -touch ? gap : 0.0;
    result.plane.offset += overlap;
    const Vec3 fall = body.fall(gravity);
    const auto rolled = roll(body, result.plane, fall, span);
    if (!rolled) return {};
    result.start = state_of(body);
    result.end = rolled->end;
    result.slipped = rolled->slipped;
    result.end.position -= lifted_share * overlap * plane->normal;
    result.impulse = momenta(result.end.position, result.end.momentum, result.end.angular_momentum) -
                     momenta(body.position, body.momentum, body.angular_momentum) -
                     Impulse{span * body.mass * fall, span * body.mass * body.position.cross(fall)};
    return result;
}

void give_impulses(const RolledContact& rolled, std::vector<Manifold>& manifolds,
                   std::span<const std::uint32_t> of_body) {
    Manifold& m = manifolds[rolled.manifold];
    for (const std::uint32_t k : of_body) {
        release(manifolds[k]);
        if (manifolds[k].a == m.a && manifolds[k].b == m.b) manifolds[k].solved_by = SolvedBy::flight;
    }
    // The load that holds the body in the next step.
    m.points[std::size_t(rolled.point)].impulse = std::max(0.0, rolled.plane.normal.dot(rolled.impulse.linear));
}

}  // namespace tumble
