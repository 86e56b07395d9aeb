// Jointed scenes built in code.
#pragma once

#include "support/scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::testing {

/// The rotation that takes x to `axis`.
inline Quat frame_along(const Vec3& axis) { return Quat::FromTwoVectors(Vec3::UnitX(), axis.normalized()); }

/// A joint at a world point with a world axis, of the poses at the start. `second` empty: the world.
inline JointDescription& add_joint(SceneDescription& scene, JointType type, std::optional<std::size_t> first,
                                   std::optional<std::size_t> second, const Vec3& anchor,
                                   const Vec3& axis = Vec3::UnitX()) {
    JointDescription joint;
    joint.name = fmt::format("joint {}", scene.joints.size());
    joint.type = type;
    joint.first = first;
    joint.second = second;
    const Quat frame = frame_along(axis);
    const auto side = [&](const std::optional<std::size_t>& body, Vec3& at, Quat& in) {
        const Quat turn = body ? scene.bodies[*body].rotation : Quat::Identity();
        const Vec3 origin = body ? scene.bodies[*body].position : Vec3(Vec3::Zero());
        at = turn.conjugate() * (anchor - origin);
        in = turn.conjugate() * frame;
    };
    side(first, joint.anchor_first, joint.frame_first);
    side(second, joint.anchor_second, joint.frame_second);
    const auto free = [](JointAxis& axis_of) { axis_of.motion = JointAxis::Motion::free; };
    if (type == JointType::hinge || type == JointType::cylindrical) free(joint.turn[0]);
    if (type == JointType::slider || type == JointType::cylindrical) free(joint.move[0]);
    if (type == JointType::universal) {
        free(joint.turn[0]);
        free(joint.turn[1]);
    }
    if (type == JointType::planar) {
        free(joint.move[1]);
        free(joint.move[2]);
        free(joint.turn[0]);
    }
    if (type == JointType::ball)
        for (JointAxis& turn : joint.turn) free(turn);
    scene.joints.push_back(joint);
    return scene.joints.back();
}

/// A rod of 1 m and 1 kg, 0.1 m thick, hinged to the world about z at the origin, `angle` (rad) from hanging.
inline SceneDescription pendulum_scene(double angle, int steps_per_frame = 16) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.sleep = false;
    const Quat q = turn(Vec3::UnitZ(), angle - 0.5 * std::numbers::pi);
    BodyDescription& rod = add_box(scene, {1.0, 0.1, 0.1}, q * Vec3(0.5, 0.0, 0.0));
    rod.rotation = q;
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    return scene;
}

/// Two such rods end to end along +x, at rest.
inline SceneDescription double_pendulum_scene(int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.sleep = false;
    for (int i = 0; i < 2; ++i) add_box(scene, {1.0, 0.1, 0.1}, {0.5 + i, 0.0, 0.0});
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 0, 1, Vec3::UnitX(), Vec3::UnitZ());
    return scene;
}

/// Eight boxes in a row with ball joints in space, with varied velocities that fit the joints only after a solve.
inline SceneDescription free_chain_scene(int links = 8) {
    SceneDescription scene = empty_scene();
    for (int i = 0; i < links; ++i) {
        BodyDescription& box = add_box(scene, {1.0, 0.1, 0.2}, {double(i), 0.0, 0.0});
        box.velocity = Vec3(0.3 * std::sin(i + 1.0), 0.5 * std::cos(2.0 * i), 0.4 * std::sin(3.0 * i + 0.5));
        if (i > 0) add_joint(scene, JointType::ball, std::size_t(i - 1), std::size_t(i), {i - 0.5, 0.0, 0.0});
    }
    return scene;
}

inline double largest_gap(const World& world) {
    double gap = 0.0;
    for (const JointState& joint : world.joint_states()) gap = std::max(gap, joint.gap);
    return gap;
}

}  // namespace tumble::testing
