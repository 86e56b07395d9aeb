// Joined bodies in contact: joints stay closed while contacts push, slide and strike.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::joint_contact_test {
using namespace tumble::testing;

namespace {

/// A chain of boxes thrown at a step of stone, its joints with dry friction.
SceneDescription thrown_chain_scene() {
    SceneDescription scene;
    scene.simulation.steps_per_frame = 4;
    const auto stone = [&](const Vec3& size, const Vec3& position) {
        BodyDescription& body = add_box(scene, size, position);
        body.type = BodyType::fixed;
        body.friction = 0.6;
    };
    stone({6.0, 1.0, 6.0}, {0.0, -0.5, 0.0});
    stone({2.0, 0.4, 6.0}, {1.5, 0.2, 0.0});
    for (int i = 0; i < 8; ++i) {
        const auto link = scene.bodies.size();
        BodyDescription& box = add_box(scene, {0.2, 0.1, 0.08}, {0.22 * i - 0.8, 0.9, 0.05 * (i % 2)});
        box.velocity = {1.0, 0.0, 0.3 * (i - 3.0)};
        box.angular_velocity = {0.0, 2.0, 0.0};
        box.friction = 0.4;
        if (i == 0) continue;
        JointDescription& joint = add_joint(scene, JointType::ball, link - 1, link, {0.22 * i - 0.91, 0.9, 0.025});
        for (JointAxis& turn : joint.turn) turn.friction = 0.02;
    }
    return scene;
}

TEST(JointContact, AThrownChainKeepsItsJointsClosed) {
    World world(thrown_chain_scene());
    double widest = 0.0, last = 1e9;
    for (int frame = 0; frame < 300; ++frame) {
        world.advance_frame();
        for (const JointState& joint : world.joint_states()) widest = std::max(widest, joint.gap);
        const Measurement m = world.measure();
        const double energy = m.kinetic + m.potential;
        // Overlaps that are pushed out lift the links by micrometers.
        EXPECT_LT(energy, last + 1e-4) << "frame " << frame;
        last = energy;
    }
    EXPECT_LT(widest, 1e-6);
    for (const BodyState& body : world.snapshot().bodies) EXPECT_TRUE(body.asleep || body.mass == 0.0);
}

}  // namespace
}  // namespace tumble::joint_contact_test
