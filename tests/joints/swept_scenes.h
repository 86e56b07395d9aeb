// Scenes whose joints are solved in sweeps.
#pragma once

#include "joint_scenes.h"

#include <utility>

namespace tumble::testing {

inline void add_floor(SceneDescription& scene) {
    BodyDescription& floor = add_body(scene, PlaneShape{}, Vec3::Zero());
    floor.type = BodyType::fixed;
    floor.friction = 0.5;
    floor.restitution = 0.0;
}

inline SceneDescription swept(SceneDescription scene) {
    scene.simulation.contact_solver = ContactSolverChoice::soft;
    return scene;
}

inline void limit_turn(JointAxis& axis, double lower, double upper) {
    axis.motion = JointAxis::Motion::limited;
    axis.lower = lower;
    axis.upper = upper;
}

// A trunk with a limb of each kind: hinge, weld, universal joint, and ball within a cone and limits of twist.
inline SceneDescription figure_scene(int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    add_box(scene, {0.4, 0.3, 0.2}, Vec3::Zero(), 4.0);
    const auto limb = [&](JointType type, const Vec3& way, const Vec3& axis) -> JointDescription& {
        add_box(scene, Vec3(0.1, 0.1, 0.1) + 0.4 * way.cwiseAbs(), 0.5 * way, 1.0);
        return add_joint(scene, type, 0, scene.bodies.size() - 1, 0.22 * way, axis);
    };
    limit_turn(limb(JointType::hinge, Vec3::UnitX(), Vec3::UnitZ()).turn[0], -0.5, 1.0);
    limb(JointType::fixed, -Vec3::UnitX(), Vec3::UnitX());
    limb(JointType::universal, Vec3::UnitY(), Vec3::UnitX());
    JointDescription& ball = limb(JointType::ball, -Vec3::UnitY(), -Vec3::UnitY());
    ball.swing = {0.6, 0.6};
    limit_turn(ball.turn[0], -0.4, 0.4);
    return scene;
}

inline double total_energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

inline std::pair<Vec3, Vec3> momenta_of(const World& world) {
    std::pair<Vec3, Vec3> sum{Vec3::Zero(), Vec3::Zero()};
    for (const BodyState& body : world.snapshot().bodies) {
        sum.first += body.momentum;
        sum.second += body.angular_momentum + body.center_of_mass.cross(body.momentum);
    }
    return sum;
}

}  // namespace tumble::testing
