// Single bodies as values, for tests of the parts of the simulation below World.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/dynamics/body_builder.h"
#include "sim/math/mass_properties.h"
#include "support/scenes.h"

#include <memory>
#include <vector>

namespace tumble::testing {

inline Body free_body(const Shape& shape, double mass, const Vec3& position, const Vec3& velocity, const Quat& rotation,
                      const Vec3& angular_velocity) {
    BodyDescription d;
    d.shape = shape;
    d.mass = mass;
    d.position = position;
    d.velocity = velocity;
    d.rotation = rotation;
    d.angular_velocity = angular_velocity;
    return BodyBuilder().build(d, IntegratorKind::exact);
}

inline Body free_ball(double radius, double mass, const Vec3& position, const Vec3& velocity) {
    return free_body(SphereShape{radius}, mass, position, velocity, Quat::Identity(), Vec3::Zero());
}

inline Body free_box(const Vec3& size, double mass, const Vec3& position, const Vec3& velocity, const Quat& rotation,
                     const Vec3& angular_velocity) {
    return free_body(BoxShape{size}, mass, position, velocity, rotation, angular_velocity);
}

/// The hull of points, with the mass distribution of a ball about the origin.
inline Body free_hull(const std::vector<Vec3>& points, double mass, const Vec3& position, const Vec3& velocity,
                      const Vec3& angular_velocity) {
    Body body = free_ball(1.0, mass, position, velocity);
    body.collider = std::make_shared<const Polyhedron>(make_hull(points, Vec3::Zero()));
    body.radius = bounding_radius(body.collider);
    body.angular_momentum = body.inertia_body * angular_velocity;
    body.derive();
    return body;
}

}  // namespace tumble::testing
