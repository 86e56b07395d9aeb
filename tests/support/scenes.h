// Small scenes built in code, for tests of the simulation without files.
#pragma once

#include "scene/description/description.h"
#include "sim/world.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace tumble::testing {

/// No ground, no gravity: free space at 60 frames a second.
inline SceneDescription empty_scene(int steps_per_frame = 16) {
    SceneDescription scene;
    scene.simulation.gravity = Vec3::Zero();
    scene.simulation.steps_per_frame = steps_per_frame;
    return scene;
}

inline BodyDescription& add_body(SceneDescription& scene, const Shape& shape, const Vec3& position) {
    BodyDescription body;
    body.name = std::to_string(scene.bodies.size());
    body.shape = shape;
    body.position = position;
    scene.bodies.push_back(body);
    return scene.bodies.back();
}

/// Gravity and a ground plane y = 0 (body 0) of the given restitution and friction.
inline SceneDescription ground_scene(double restitution, double friction, int steps_per_frame = 16) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    BodyDescription& ground = add_body(scene, PlaneShape{}, Vec3::Zero());
    ground.type = BodyType::fixed;
    ground.restitution = restitution;
    ground.friction = friction;
    return scene;
}

inline BodyDescription& add_box(SceneDescription& scene, const Vec3& size, const Vec3& position, double mass = 1.0) {
    BodyDescription& body = add_body(scene, BoxShape{size}, position);
    body.mass = mass;
    body.restitution = 0.0;
    return body;
}

inline BodyDescription& add_sphere(SceneDescription& scene, double radius, const Vec3& position, double mass = 1.0) {
    BodyDescription& body = add_body(scene, SphereShape{radius}, position);
    body.mass = mass;
    body.restitution = 0.0;
    return body;
}

/// For tests in water: at `height` over the origin, m.
inline BodyDescription& float_body(SceneDescription& scene, const Shape& shape, double density, double height) {
    BodyDescription& body = add_body(scene, shape, {0.0, height, 0.0});
    body.density = density;
    return body;
}

/// At all times.
inline PairForceDescription& add_pair_force(SceneDescription& scene, PairForceKind type, double strength,
                                            std::vector<std::size_t> bodies) {
    PairForceDescription force;
    force.type = type;
    force.strength = strength;
    force.bodies = std::move(bodies);
    force.end = infinity;
    return scene.pair_forces.emplace_back(force);
}

inline Quat turn(const Vec3& axis, double radians) { return Quat(Eigen::AngleAxisd(radians, axis.normalized())); }

inline void run(World& world, const SceneDescription& scene, double seconds) {
    const auto frames = std::int64_t(std::llround(seconds * scene.output.fps));
    for (std::int64_t i = 0; i < frames; ++i) world.advance_frame();
}

}  // namespace tumble::testing
