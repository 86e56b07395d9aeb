// Random trees and loops of joints with all laws, in the air and on a floor: the state stays finite and in bounds.
#include "joint_scenes.h"
#include "sim/random_shapes.h"
#include "sim/world.h"
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::random_test {
using namespace tumble::testing;

namespace {

void add_laws(JointDescription& joint, Random& random) {
    const bool turns = joint.type == JointType::hinge;
    if (!turns && joint.type != JointType::slider) return;
    JointAxis& axis = turns ? joint.turn[0] : joint.move[0];
    if (random.below(3) == 0) {
        limit_turn(axis, random(-1.0, -0.003), random(0.003, 1.0));
        axis.restitution = 0.4 * random.below(3);
    }
    if (random.below(4) == 0) axis.friction = random(0.01, 2.0);
    if (random.below(5) == 0)
        axis.spring =
            JointSpring{.stiffness = std::exp(random(0.0, 8.0)), .damping = random.below(2) * random(0.0, 5.0)};
    if (random.below(7) == 0) {
        axis.motor.emplace().speed = random(-3.0, 3.0);
        axis.motor->max_force = random(1.0, 20.0);
    }
}

SceneDescription random_scene(std::uint64_t seed) {
    Random random(seed);
    SceneDescription scene;
    constexpr int rates[] = {1, 2, 4};
    scene.simulation.steps_per_frame = rates[random.below(3)];
    if (random.below(7) == 0) scene.simulation.gravity.setZero();
    const int n = 2 + random.below(8);
    constexpr double speeds[] = {0.0, 1.0, 5.0, 20.0};
    const double speed = speeds[random.below(4)];
    for (int i = 0; i < n; ++i) {
        const Vec3 size(random(0.1, 0.5), random(0.1, 0.5), random(0.1, 0.5)),
            at(0.6 * i + random(-0.05, 0.05), 1.2 + random(-0.2, 0.5), random(-0.2, 0.2));
        BodyDescription& box = add_box(scene, size, at, std::exp(random(-2.0, 2.0)));
        box.rotation = random.turn();
        box.velocity = random.vector(speed);
        box.angular_velocity = random.vector(speed);
        box.friction = 0.5 * random.below(2);
        box.restitution = 0.3 * random.below(3);
    }
    constexpr JointType types[] = {JointType::hinge,     JointType::hinge, JointType::ball,       JointType::slider,
                                   JointType::universal, JointType::fixed, JointType::cylindrical};
    const bool chain = random.below(2) == 0;
    for (int i = 1; i < n; ++i) {
        const int before = chain ? i - 1 : std::max(0, i - 1 - random.below(2));
        const Vec3 anchor = 0.5 * (scene.bodies[std::size_t(i)].position + scene.bodies[std::size_t(before)].position);
        JointDescription& joint =
            add_joint(scene, types[random.below(7)], std::size_t(before), std::size_t(i), anchor, random.direction());
        add_laws(joint, random);
        if (random.below(12) == 0) joint.break_force = std::exp(random(2.0, 6.0));
    }
    if (chain && n > 2 && random.below(3) == 0)
        add_joint(scene, JointType::ball, std::size_t(n - 1), 0,
                  0.5 * (scene.bodies[0].position + scene.bodies[std::size_t(n - 1)].position));
    if (random.below(10) < 7) add_floor(scene);
    return scene;
}

}  // namespace

double energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential + m.elastic - world.contact_records().energy.work;
}

// In a frame the energy grows by the error of the integrator alone.
TEST(RandomJoints, StayFiniteAndGainNoEnergy) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        World world(random_scene(seed));
        world.record_contacts();
        double last = energy(world), gain = 0.0, mass = 0.0;
        for (const BodyState& body : world.snapshot().bodies) mass += body.mass;
        const double scale = world.measure().kinetic + 9.81 * mass;  // J: a fall by 1 m
        for (int frame = 0; frame < 45; ++frame) {
            ASSERT_NO_THROW(world.advance_frame()) << seed;
            const double now = energy(world);
            gain = std::max(gain, now - last);
            last = now;
        }
        EXPECT_LT(gain, 0.01 * scale) << seed;
    }
}

namespace {

// Two bodies that overlap more than the rod between them ever allows to move out.
SceneDescription jammed_pair(std::uint64_t seed) {
    Random random(seed);
    SceneDescription scene = empty_scene();
    scene.simulation.steps_per_frame = 1;
    const auto add = [&](const Vec3& at) {
        BodyDescription& body = random.below(2) == 0
                                    ? add_box(scene, {random(0.1, 0.25), random(0.1, 0.25), random(0.1, 0.25)}, at,
                                              std::exp(random(-1.0, 2.0)))
                                    : add_sphere(scene, random(0.06, 0.12), at, std::exp(random(-1.0, 2.0)));
        body.velocity = random.vector(2.0);
        body.angular_velocity = random.vector(6.0);
        body.restitution = 0.3 * random.below(3);
        body.friction = 0.3 * random.below(3);
    };
    add({0.0, 1.0, 0.0});
    add({random(-0.05, 0.05), 1.08, random(-0.05, 0.05)});
    JointDescription& rod = add_joint(scene, JointType::distance, 0, 1, Vec3::Zero());
    rod.anchor_first = {0.0, 0.03, 0.0};
    rod.anchor_second = {0.0, -0.03, 0.0};
    rod.collide = true;
    rod.length = (scene.bodies[1].position - scene.bodies[0].position - Vec3(0.0, 0.06, 0.0)).norm();
    return scene;
}

}  // namespace

// Contact and rod exclude each other: their impulses have no limit, and must not become energy.
TEST(RandomJoints, JammedPairsGainNoEnergy) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        World world(jammed_pair(seed));
        const double start = world.measure().kinetic;
        double most = 0.0;
        for (int frame = 0; frame < 120; ++frame) {
            world.advance_frame();
            most = std::max(most, world.measure().kinetic);
        }
        EXPECT_LT(most, 1.5 * start) << seed;
    }
}

}  // namespace tumble::random_test
