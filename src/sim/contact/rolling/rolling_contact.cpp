#include "sim/contact/rolling/rolling_contact.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/contact/model/turning_resistance.h"
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
    if (other.moves() || resists_turning(other)) return {};
    const auto plane = [&](const Vec3& normal, double offset) {
        const Vec3 world = other.rotation * normal;
        return RollingPlane{world, offset + world.dot(other.position), pair_friction(body, other)};
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

std::optional<RolledContact> roll_alone(std::uint32_t i, const std::vector<Body>& bodies,
                                        std::vector<Manifold>& manifolds, std::span<const std::uint32_t> of_body,
                                        const ForceField& forces, const Vec3& gravity, double span) {
    Body body = bodies[i];
    if (!std::holds_alternative<std::shared_ptr<const CurvedBody>>(body.collider) || body.jointed ||
        resists_turning(body) || of_body.empty() || !forces.only_gravity(i))
        return {};
    std::optional<std::pair<std::uint32_t, int>> found;
    std::uint32_t other = UINT32_MAX;
    double gap = 0.0;
    for (const std::uint32_t k : of_body) {
        const Manifold& m = manifolds[k];
        const std::uint32_t on = m.a == i ? m.b : m.a;
        if (other != UINT32_MAX && on != other) return {};
        other = on;
        const double touch = touch_distance(body.radius, bodies[on].radius);
        for (int p = 0; p < m.count; ++p) {
            const double separation = m.points[std::size_t(p)].separation;
            if (found && std::max(gap, separation) <= touch) return {};
            if (found && separation >= gap) continue;
            found = {k, p};
            gap = separation;
        }
    }
    if (!found || gap < -deep_overlap * body.radius) return {};
    auto plane = plane_of(manifolds[found->first], body, bodies[other], span);
    if (!plane) return {};
    body.derive();
    const double overlap = gap < -touch_distance(body.radius, bodies[other].radius) ? gap : 0.0;
    plane->offset += overlap;
    const Vec3 fall = body.fall(gravity);
    const auto rolled = roll(body, *plane, fall, span);
    if (!rolled) return {};
    RolledContact result{i, found->first, *plane, state_of(body), rolled->end, {}, rolled->slipped};
    result.end.position -= lifted_share * overlap * plane->normal;
    result.impulse = momenta(result.end.position, result.end.momentum, result.end.angular_momentum) -
                     momenta(body.position, body.momentum, body.angular_momentum) -
                     Impulse{span * body.mass * fall, span * body.mass * body.position.cross(fall)};
    for (const std::uint32_t k : of_body) {
        release(manifolds[k]);
        manifolds[k].solved_by = SolvedBy::flight;
    }
    // The load that holds the body in the next step.
    manifolds[found->first].points[std::size_t(found->second)].impulse =
        std::max(0.0, plane->normal.dot(result.impulse.linear));
    return result;
}

}  // namespace tumble
