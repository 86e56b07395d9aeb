#include "sim/geometry/collider.h"

#include "sim/geometry/compound.h"

namespace tumble {
namespace {

template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // clang 14 needs it

// The bounding box of a rotated box: |R| times the half extents (Ericson 2005, "Real-Time Collision Detection", 4.2.6).
Bounds around(const Vec3& center, const Vec3& half_extent, const Pose& pose) {
    const Vec3 half = pose.rotation.cwiseAbs() * half_extent;
    return {center - half, center + half};
}
Bounds of_polyhedron(const Polyhedron& p, const Pose& pose) {
    return p.is_box ? around(pose.position, p.half_extent, pose) : posed_bounds(p.bounds, pose);
}

}  // namespace

Bounds posed_bounds(const Bounds& local, const Pose& pose) {
    return around(pose.to_world(local.center()), 0.5 * local.extent(), pose);
}

Bounds world_bounds(const CollisionShape& collider, const Pose& pose) {
    return std::visit(
        Overloaded{[&](const HalfSpace&) {
                       return Bounds{Vec3::Constant(-infinity), Vec3::Constant(infinity)};
                   },
                   [&](const Ball& ball) {
                       return Bounds{pose.position, pose.position}.grown(ball.radius);
                   },
                   [&](const std::shared_ptr<const Polyhedron>& p) { return of_polyhedron(*p, pose); },
                   [&](const std::shared_ptr<const CollisionMesh>& s) { return posed_bounds(s->tree.bounds(), pose); },
                   [&](const std::shared_ptr<const Compound>& c) { return posed_bounds(c->tree.bounds(), pose); }},
        collider);
}

double bounding_radius(const CollisionShape& collider) {
    return std::visit(
        Overloaded{[](const HalfSpace&) { return infinity; }, [](const Ball& ball) { return ball.radius; },
                   [](const std::shared_ptr<const Polyhedron>& p) { return p->radius; },
                   [](const std::shared_ptr<const CollisionMesh>& s) { return s->radius; },
                   [](const std::shared_ptr<const Compound>& c) { return c->radius; }},
        collider);
}

double depth(const CollisionShape& collider) {
    return std::visit(
        Overloaded{[](const HalfSpace&) { return infinity; }, [](const Ball& ball) { return ball.radius; },
                   [](const std::shared_ptr<const Polyhedron>& p) { return p->inner_radius; },
                   [](const std::shared_ptr<const CollisionMesh>&) { return infinity; },
                   [](const std::shared_ptr<const Compound>& c) { return c->inner_radius; }},
        collider);
}

}  // namespace tumble
