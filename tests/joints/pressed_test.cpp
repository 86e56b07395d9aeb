// Limits with restitution under load: a joint that forces, motors or an accelerating carrier press on its limit does
// not rebound in each step, and carries the load. Impacts remain impacts.
#include "joint_scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::joint_pressed_test {
using namespace tumble::testing;

namespace {

struct Load {
    double loss = 0.0;                                 // J, of impacts
    double travel = 0.0;                               // m or rad, the farthest from the limit
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N, N m: on the second body, mean of the second half
};

/// `coordinate`: of joint 0, which starts at its limit.
Load measure(const SceneDescription& scene, std::size_t coordinate) {
    World world(scene);
    world.record_contacts();
    Load load;
    constexpr int frames = 60;
    for (int frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        const JointState joint = world.joint_states()[0];
        load.travel = std::max(load.travel, std::abs(joint.position[coordinate]));
        if (2 * frame < frames) continue;
        load.force += joint.mean_force / (0.5 * frames);
        load.torque += joint.mean_torque / (0.5 * frames);
    }
    load.loss = world.contact_records().energy.impact_loss;
    return load;
}

constexpr ImpactMode modes[] = {ImpactMode::stepped, ImpactMode::exact};
constexpr double restitutions[] = {0.2, 0.5, 0.9};

void limit(JointAxis& axis, double lower, double upper, double restitution) {
    axis.motion = JointAxis::Motion::limited;
    axis.lower = lower;
    axis.upper = upper;
    axis.restitution = restitution;
}

void push(SceneDescription& scene, std::size_t body, const Vec3& force, const Vec3& point = Vec3::Zero()) {
    scene.forces.push_back({.body = body, .point = point, .force = force, .end = infinity});
}

SceneDescription scene_in(ImpactMode mode) {
    SceneDescription scene = empty_scene();
    scene.simulation.impacts = mode;
    return scene;
}

std::string which(ImpactMode mode, double e) {
    return fmt::format("{}, e = {}", mode == ImpactMode::exact ? "exact" : "stepped", e);
}

/// A box of 2 kg on a slider along x whose lower limit is its place.
SceneDescription slider_scene(ImpactMode mode, double e) {
    SceneDescription scene = scene_in(mode);
    add_box(scene, {0.4, 0.4, 0.4}, Vec3::Zero(), 2.0);
    add_joint(scene, JointType::slider, std::nullopt, 0, Vec3::Zero());
    limit(scene.joints[0].move[0], 0.0, 1.0, e);
    return scene;
}

// 100 N: by forces on the box itself, or on another that is joined to it.
TEST(JointPressed, AForceOnALimitOfASlider) {
    for (const ImpactMode mode : modes)
        for (const double e : restitutions)
            for (const bool through : {false, true}) {
                SceneDescription scene = slider_scene(mode, e);
                if (through) {
                    add_box(scene, {0.4, 0.4, 0.4}, {1.0, 0.0, 0.0}, 3.0);
                    add_joint(scene, JointType::fixed, 0, 1, {0.5, 0.0, 0.0});
                }
                push(scene, through, {-100.0, 0.0, 0.0});
                const Load load = measure(scene, 0);
                EXPECT_NEAR(load.force.x(), 100.0, 1e-3) << which(mode, e) << through;
                EXPECT_LT(load.loss, 1e-6) << which(mode, e) << through;
                EXPECT_LT(load.travel, 1e-6) << which(mode, e) << through;
            }
}

// 100 N at 0.5 m from the hinge.
TEST(JointPressed, AForceOnALimitOfAHinge) {
    for (const ImpactMode mode : modes)
        for (const double e : restitutions) {
            SceneDescription scene = scene_in(mode);
            add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0}, 2.0);
            add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
            limit(scene.joints[0].turn[0], -1.0, 0.0, e);
            push(scene, 0, {0.0, 100.0, 0.0});
            const Load load = measure(scene, 3);
            EXPECT_NEAR(load.torque.z(), -50.0, 1e-3) << which(mode, e);
            EXPECT_LT(load.loss, 1e-6) << which(mode, e);
            EXPECT_LT(load.travel, 1e-6) << which(mode, e);
        }
}

// The motor's force and the limit's cancel.
TEST(JointPressed, AMotorOnALimit) {
    for (const ImpactMode mode : modes)
        for (const double e : restitutions) {
            SceneDescription scene = slider_scene(mode, e);
            JointMotor& motor = scene.joints[0].move[0].motor.emplace();
            motor.speed = -1.0;
            motor.max_force = 100.0;
            const Load load = measure(scene, 0);
            EXPECT_LT(load.force.norm(), 1e-3) << which(mode, e);
            EXPECT_LT(load.loss, 1e-6) << which(mode, e);
            EXPECT_LT(load.travel, 1e-6) << which(mode, e);
        }
}

// A carrier that accelerates with 3 g takes a box along at its limit.
TEST(JointPressed, ACarrierThatAccelerates) {
    for (const ImpactMode mode : modes)
        for (const double e : restitutions) {
            SceneDescription scene = scene_in(mode);
            BodyDescription& carrier = add_box(scene, {0.4, 0.4, 0.4}, Vec3::Zero());
            carrier.type = BodyType::kinematic;
            for (int k = 0; k <= 240; ++k) {
                const double t = k / 120.0;
                carrier.keyframes.push_back({t, {0.5 * 3.0 * 9.81 * t * t, 0.0, 0.0}});
            }
            add_box(scene, {0.4, 0.4, 0.4}, {1.0, 0.0, 0.0}, 2.0);
            add_joint(scene, JointType::slider, 0, 1, {1.0, 0.0, 0.0});
            limit(scene.joints[0].move[0], 0.0, 1.0, e);
            const Load load = measure(scene, 0);
            EXPECT_NEAR(load.force.x(), 2.0 * 3.0 * 9.81, 0.01) << which(mode, e);
            EXPECT_LT(load.loss, 1e-6) << which(mode, e);
            EXPECT_LT(load.travel, 1e-4) << which(mode, e);
        }
}

// A box that flies to its limit under load bounces there, and comes to rest: after 1.4 s with e = 0.8.
TEST(JointPressed, AnImpactOnALimitBounces) {
    for (const ImpactMode mode : modes)
        for (const double e : {0.2, 0.5, 0.8}) {
            SceneDescription scene = slider_scene(mode, e);
            limit(scene.joints[0].move[0], -0.5, 1.0, e);
            push(scene, 0, {-100.0, 0.0, 0.0});
            World world(scene);
            double fastest = 0.0;
            for (int step = 0; step < 160; ++step) {
                world.step();
                fastest = std::max(fastest, world.joint_states()[0].speed[0]);
            }
            // sqrt(2 a s) on arrival, with a = 50 m/s^2 and s = 0.5 m, less a step or two of a h.
            EXPECT_NEAR(fastest, e * std::sqrt(50.0), 0.11) << which(mode, e);
            run(world, scene, 2.0);
            EXPECT_NEAR(world.joint_states()[0].position[0], -0.5, 1e-6) << which(mode, e);
            EXPECT_NEAR(world.joint_states()[0].speed[0], 0.0, 1e-6) << which(mode, e);
        }
}

}  // namespace
}  // namespace tumble::joint_pressed_test
