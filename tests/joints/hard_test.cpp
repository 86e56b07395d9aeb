// Hard and extreme joints: never a state that is not finite, never energy from nothing.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::hard_test {
using namespace tumble::testing;

namespace {

struct Outcome {
    double gap = 0.0, gain = 0.0;  // m; J, largest energy above the start's
};

Outcome run_hard(const SceneDescription& scene, double seconds) {
    World world(scene);
    const auto energy = [&] {
        const Measurement m = world.measure();
        return m.kinetic + m.potential;
    };
    const double start = energy();
    Outcome outcome;
    for (int frame = 0; frame < int(60.0 * seconds); ++frame) {
        world.advance_frame();
        outcome.gap = std::max(outcome.gap, largest_gap(world));
        outcome.gain = std::max(outcome.gain, energy() - start);
    }
    EXPECT_TRUE(std::isfinite(energy()));
    return outcome;
}

TEST(JointHard, AHingeSpinsAtTenThousandRadiansASecond) {
    SceneDescription scene = empty_scene();
    add_box(scene, {1.0, 0.1, 0.1}, Vec3::Zero());
    scene.bodies[0].angular_velocity = {0.0, 0.0, 1e4};
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    const Outcome o = run_hard(scene, 1.0);
    EXPECT_LT(o.gap, 1e-9);
    EXPECT_LT(o.gain, 1.0);  // of 4 MJ
}

TEST(JointHard, ALightLinkBetweenHeavyBodies) {
    SceneDescription scene = empty_scene();
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}, 1e4).velocity = {0.0, 1.0, 0.0};
    add_box(scene, {0.2, 0.05, 0.05}, {0.6, 0.0, 0.0}, 1e-4);
    add_box(scene, {1.0, 1.0, 1.0}, {1.2, 0.0, 0.0}, 1e4);
    add_joint(scene, JointType::ball, 0, 1, {0.5, 0.0, 0.0});
    add_joint(scene, JointType::ball, 1, 2, {0.7, 0.0, 0.0});
    const Outcome o = run_hard(scene, 0.1);
    EXPECT_LT(o.gap, 1e-6);
    EXPECT_LT(o.gain, 5.0);  // of 5 kJ
}

TEST(JointHard, ALimitViolatedAtTheStartIsEasedIn) {
    SceneDescription scene = empty_scene();
    add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0});
    JointDescription& hinge = add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    hinge.turn[0].motion = JointAxis::Motion::limited;
    hinge.turn[0].lower = 0.5;
    hinge.turn[0].upper = 1.0;
    const Outcome o = run_hard(scene, 1.0);
    EXPECT_LT(o.gain, 1e-6);
    World world(scene);
    run(world, scene, 1.0);
    EXPECT_NEAR(world.joint_states()[0].position[3], 0.5, 1e-6);
}

TEST(JointHard, AMotorAgainstItsLimitAndAContact) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    add_box(scene, {1.0, 0.1, 0.1}, {0.5, 1.0, 0.0});
    JointDescription& hinge = add_joint(scene, JointType::hinge, std::nullopt, 1, {0.0, 1.0, 0.0}, Vec3::UnitZ());
    hinge.turn[0].motor = JointMotor{.speed = -10.0, .targets = {}, .max_force = 1e5};
    World world(scene);
    run(world, scene, 3.0);
    EXPECT_LT(world.measure().kinetic, 1e3);
    EXPECT_LT(largest_gap(world), 1e-4);
}

TEST(JointHard, ALoopThatCannotClose) {
    SceneDescription scene = empty_scene();
    add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0});
    add_joint(scene, JointType::ball, std::nullopt, 0, Vec3::Zero());
    JointDescription& far = add_joint(scene, JointType::ball, std::nullopt, 0, {1.0, 0.0, 0.0});
    far.anchor_first = {3.0, 0.0, 0.0};  // two meters away
    const Outcome o = run_hard(scene, 2.0);
    EXPECT_LT(o.gain, 1e-3);
}

TEST(JointHard, AnchorsAKilometerApart) {
    SceneDescription scene = empty_scene();
    add_box(scene, {0.2, 0.2, 0.2}, {0.0, 0.0, 0.0});
    add_box(scene, {0.2, 0.2, 0.2}, {1000.0, 0.0, 0.0});
    JointDescription& joint = add_joint(scene, JointType::ball, 0, 1, {0.0, 0.0, 0.0});
    joint.anchor_second = Vec3::Zero();
    const Outcome o = run_hard(scene, 2.0);
    EXPECT_LT(o.gain, 1e-3);
}

// A carriage on rails that a kinematic platform turns; each type of joint on a tumbling pair.
TEST(JointHard, EveryTypeKeepsItsMomentaAndGap) {
    for (const JointType type : {JointType::fixed, JointType::hinge, JointType::ball, JointType::slider,
                                 JointType::universal, JointType::cylindrical, JointType::planar}) {
        SceneDescription scene = empty_scene();
        add_box(scene, {0.4, 0.2, 0.3}, {0.0, 0.0, 0.0}, 2.0);
        add_box(scene, {0.3, 0.1, 0.2}, {0.6, 0.1, 0.0}, 1.0);
        scene.bodies[0].angular_velocity = {1.0, 2.0, -1.0};
        scene.bodies[1].velocity = {0.1, -0.4, 0.3};
        add_joint(scene, type, 0, 1, {0.3, 0.05, 0.0}, {1.0, 0.4, -0.3});
        World world(scene);
        world.step();
        const Measurement first = world.measure();
        double gap = 0.0, energy = 0.0;
        for (int step = 0; step < 2000; ++step) {
            world.step();
            gap = std::max(gap, largest_gap(world));
            energy = std::max(energy, std::abs(world.measure().kinetic - first.kinetic));
        }
        const Measurement last = world.measure();
        EXPECT_LT(gap, 1e-12);
        EXPECT_LT(energy, 1e-4 * first.kinetic);
        EXPECT_LT((last.momentum - first.momentum).norm(), 1e-13);
        EXPECT_LT((last.angular_momentum - first.angular_momentum).norm(), 1e-12);
    }
}

TEST(JointHard, ARopeAndARod) {
    for (const bool rod : {true, false}) {
        SceneDescription scene;
        add_sphere(scene, 0.1, {1.0, 0.0, 0.0});
        JointDescription& joint = add_joint(scene, JointType::distance, std::nullopt, 0, Vec3::Zero());
        joint.anchor_second = Vec3::Zero();
        joint.length = 1.0;
        if (!rod) {
            joint.move[0].motion = JointAxis::Motion::limited;
            joint.move[0].upper = 1.2;
        }
        World world(scene);
        double farthest = 0.0;
        for (int frame = 0; frame < 240; ++frame) {
            world.advance_frame();
            farthest = std::max(farthest, world.snapshot().bodies[0].center_of_mass.norm());
        }
        EXPECT_NEAR(farthest, rod ? 1.0 : 1.2, 1e-9);
    }
}

// Two rods with velocities that contradict their joints, one beyond its limit, and joints too weak for that: both break
// in the first step. All of the energy that they take is counted.
TEST(JointHard, JointsThatBreakAtOnceLoseWhatTheyTake) {
    for (const IntegratorKind integrator : {IntegratorKind::runge_kutta_4, IntegratorKind::exact})
        for (const int steps : {1, 16})
            for (const double lower : {-1.0, 0.2}) {
                SceneDescription scene;
                scene.simulation.steps_per_frame = steps;
                scene.simulation.integrator = integrator;
                add_box(scene, {0.5, 0.1, 0.1}, {0.25, 0.0, 0.0}, 2.0).velocity = {3.0, 1.0, 0.0};
                BodyDescription& second = add_box(scene, {0.5, 0.1, 0.1}, {0.75, 0.0, 0.0});
                second.velocity = {-1.0, 5.0, 0.0};
                second.angular_velocity = {0.0, 0.0, -4.0};
                add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ()).break_force = 50.0;
                JointDescription& weak = add_joint(scene, JointType::hinge, 0, 1, {0.5, 0.0, 0.0}, Vec3::UnitZ());
                weak.break_force = 30.0;
                weak.turn[0].motion = JointAxis::Motion::limited;
                weak.turn[0].lower = lower;
                weak.turn[0].upper = 1.0;
                World world(scene);
                world.record_contacts();
                const auto sum = [&] {
                    const Measurement m = world.measure();
                    const EnergyLedger& ledger = world.contact_records().energy;
                    return m.kinetic + m.potential + ledger.impact_loss + ledger.friction_loss;
                };
                const double start = sum(), kinetic = world.measure().kinetic;
                // A long step mixes the impulse with that of gravity.
                const double error = (steps > 1 ? 1e-9 : 1e-4) * kinetic;
                for (int frame = 0; frame < 30; ++frame) {
                    world.advance_frame();
                    ASSERT_NEAR(sum(), start, error) << steps << ", " << lower << ", " << frame;
                }
                EXPECT_TRUE(world.joint_states()[0].broken_at.has_value());
                EXPECT_TRUE(world.joint_states()[1].broken_at.has_value());
            }
}

// The same bytes for any number of threads.
TEST(JointHard, ThreadsDoNotChangeAByte) {
    SceneDescription scene = ground_scene(0.2, 0.5);
    for (int c = 0; c < 12; ++c)
        for (int i = 0; i < 6; ++i) {
            add_box(scene, {0.2, 0.1, 0.1}, {0.2 * i, 0.5 + 0.3 * c, 0.4 * (c % 3)}).friction = 0.4;
            const std::size_t body = scene.bodies.size() - 1;
            if (i > 0) add_joint(scene, JointType::ball, body - 1, body, {0.2 * i - 0.1, 0.5 + 0.3 * c, 0.4 * (c % 3)});
        }
    World one(scene, 1), four(scene, 4);
    for (int frame = 0; frame < 60; ++frame) {
        one.advance_frame();
        four.advance_frame();
        const Snapshot a = one.snapshot(), b = four.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i) {
            ASSERT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass) << frame << " " << i;
            ASSERT_EQ(a.bodies[i].orientation.coeffs(), b.bodies[i].orientation.coeffs());
        }
    }
}

}  // namespace
}  // namespace tumble::hard_test
