// Limits, motors, springs, friction and breaking against their closed forms.
#include "harness/breaking_pendulum.h"
#include "joint_scenes.h"
#include "sim/joints/joint.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::laws_test {
using namespace tumble::testing;

namespace {

/// A door of 0.9 m x 2 m x 0.04 m and 20 kg, hinged on its vertical edge; I = 5.40266... kg m^2.
SceneDescription door_scene(int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    add_box(scene, {0.9, 2.0, 0.04}, {0.45, 0.0, 0.0}, 20.0);
    JointDescription& hinge = add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY());
    hinge.turn[0].motion = JointAxis::Motion::limited;
    hinge.turn[0].lower = -1.0;
    hinge.turn[0].upper = 0.5 * std::numbers::pi;
    return scene;
}

TEST(JointLaws, AMotorOpensADoorToItsLimit) {
    SceneDescription scene = door_scene(16);
    JointMotor motor;
    motor.speed = 1.0;
    motor.max_force = 10.0;
    scene.joints[0].turn[0].motor = motor;
    World world(scene);
    double full = 0.0, limit = 0.0, farthest = 0.0;
    for (int step = 1; step <= 5 * 960; ++step) {
        world.step();
        const JointState joint = world.joint_states()[0];
        if (full == 0.0 && joint.speed[3] > 1.0 - 1e-9) full = step / 960.0;
        if (limit == 0.0 && joint.limit != 0) limit = step / 960.0;
        farthest = std::max(farthest, joint.position[3]);
    }
    EXPECT_NEAR(full, 0.540266666666, 1.1 / 960.0);
    EXPECT_NEAR(limit, 1.84092966012822995, 1.6 / 960.0);
    EXPECT_LT(farthest - 0.5 * std::numbers::pi, 1e-9);
    EXPECT_TRUE(world.snapshot().bodies[0].asleep);
    EXPECT_NEAR(world.joint_states()[0].position[3], 0.5 * std::numbers::pi, 1e-12);
}

// At 100 rad/s and 60 steps a second the limit comes in the first step, which starts with velocities that fit the
// joint.
TEST(JointLaws, AFastRodStopsAtItsLimit) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi, 1);
    scene.simulation.gravity = Vec3::Zero();
    scene.bodies[0].angular_velocity = {0.0, 0.0, 100.0};
    scene.bodies[0].velocity = {0.0, 50.0, 0.0};
    JointAxis& angle = scene.joints[0].turn[0];
    angle.motion = JointAxis::Motion::limited;
    angle.lower = -0.5 * std::numbers::pi;
    for (const double limit : {0.5, 5.0}) {
        angle.upper = limit * std::numbers::pi;
        World world(scene);
        for (int step = 0; step < 12; ++step) {
            world.step();
            ASSERT_LT(largest_gap(world), 1e-12);
            ASSERT_LT(world.joint_states()[0].position[3], angle.upper + 1e-9);
        }
        EXPECT_NEAR(world.joint_states()[0].position[3], angle.upper, 1e-9);
    }
}

TEST(JointLaws, ALimitWithRestitutionReturnsTheSpeed) {
    SceneDescription scene = door_scene(16);
    scene.bodies[0].angular_velocity = {0.0, 2.0, 0.0};
    scene.bodies[0].velocity = {0.0, 0.0, -0.9};
    scene.joints[0].turn[0].restitution = 0.5;
    World world(scene);
    double farthest = 0.0;
    for (int step = 1; step <= 960; ++step) {
        world.step();
        farthest = std::max(farthest, world.joint_states()[0].position[3]);
    }
    EXPECT_NEAR(world.joint_states()[0].speed[3], -1.0, 1e-5);
    EXPECT_LT(farthest, 0.5 * std::numbers::pi + 1e-12);
    EXPECT_GT(farthest, 0.5 * std::numbers::pi - 2.0 / 960.0);
}

TEST(JointLaws, ASpringRestsAtItsClosedForm) {
    // A rod on a hinge with a spring: K theta = m g l cos(theta) from the horizontal.
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    scene.joints[0].turn[0].spring = JointSpring{.stiffness = 50.0, .damping = 5.0};
    World world(scene);
    run(world, scene, 20.0);
    double angle = 0.1;
    for (int k = 0; k < 50; ++k) angle = 9.81 * 0.5 * std::cos(angle) / 50.0;
    EXPECT_NEAR(world.joint_states()[0].position[3], -angle, 1e-9);
}

TEST(JointLaws, AStiffSpringIsStable) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi, 1);
    scene.joints[0].turn[0].spring = JointSpring{.stiffness = 1e12};
    World world(scene);
    run(world, scene, 5.0);
    EXPECT_LT(std::abs(world.joint_states()[0].position[3]), 1e-9);
    EXPECT_LT(world.measure().kinetic, 1e-9);
}

// x = r (1 - cos w t) of a mass on a spring without a damper, which flies.
TEST(JointLaws, ASpringWithoutADamperSwings) {
    constexpr double rest = 0.3, rate = 10.0;
    const auto error = [&](IntegratorKind integrator, int steps) {
        SceneDescription scene = empty_scene();
        scene.simulation.integrator = integrator;
        scene.simulation.steps_per_frame = steps;
        scene.simulation.sleep = false;
        add_box(scene, {0.2, 0.2, 0.2}, {0.5, 0.0, 0.0}, 2.0);
        add_joint(scene, JointType::slider, std::nullopt, 0, {0.5, 0.0, 0.0}).move[0].spring =
            JointSpring{.stiffness = 2.0 * rate * rate, .rest = rest};
        World world(scene);
        world.record_contacts();
        double worst = 0.0;
        for (int frame = 1; frame <= 120; ++frame) {
            world.advance_frame();
            const double x = world.joint_states()[0].position[0];
            worst = std::max(worst, std::abs(x - rest * (1.0 - std::cos(rate * frame / scene.output.fps))));
        }
        const Measurement m = world.measure();
        EXPECT_NEAR(world.contact_records().energy.joint_heat, 0.0, 1e-13);
        EXPECT_NEAR(m.kinetic + m.elastic, rate * rate * rest * rest,
                    integrator == IntegratorKind::exact ? 1e-9 : 4e-3);
        return worst;
    };
    EXPECT_LT(error(IntegratorKind::exact, 4), 1e-10);
    const double coarse = error(IntegratorKind::symplectic_euler, 4), fine = error(IntegratorKind::symplectic_euler, 8);
    EXPECT_LT(fine, 2e-4);
    EXPECT_NEAR(coarse / fine, 4.0, 0.1);
}

TEST(JointLaws, AServoHoldsItsTarget) {
    SceneDescription scene = door_scene(16);
    JointMotor motor;
    motor.targets = {{0.0, 0.0}, {1.0, 1.0}};
    motor.stiffness = 1e5;
    motor.damping = 1e3;
    scene.joints[0].turn[0].motor = motor;
    World world(scene);
    run(world, scene, 0.5);
    EXPECT_NEAR(world.joint_states()[0].position[3], 0.5, 0.02);
    run(world, scene, 3.0);
    EXPECT_NEAR(world.joint_states()[0].position[3], 1.0, 1e-6);
}

// The parabola through evenly spaced keys of a parabola, at rest at both ends, without overshoot, and C1.
TEST(JointLaws, AMotorMovesSmoothlyThroughItsKeyframes) {
    JointMotor motor;
    motor.targets = {{1.0, 0.0}, {2.0, 1.0}, {3.0, 4.0}, {4.0, 9.0}, {5.0, 9.0}, {6.0, 5.0}};
    for (const auto& [time, value] : motor.targets) EXPECT_EQ(motor_target(motor, time), value);
    EXPECT_EQ(motor_target(motor, 0.0), 0.0);
    EXPECT_EQ(motor_target(motor, 7.0), 5.0);
    EXPECT_NEAR(motor_target(motor, 2.3), 1.3 * 1.3, 1e-14);
    EXPECT_EQ(motor_target(motor, 4.5), 9.0);
    const auto speed = [&](double time) {
        return (motor_target(motor, time + 1e-6) - motor_target(motor, time - 1e-6)) / 2e-6;
    };
    for (double time = 0.5; time < 6.5; time += 0.01) {
        EXPECT_NEAR(speed(time + 1e-3), speed(time), 0.1);
        EXPECT_LE(motor_target(motor, time), 9.0);
    }
    EXPECT_NEAR(speed(1.0), 0.0, 1e-5);
    motor.interpolation = Interpolation::linear;
    EXPECT_NEAR(motor_target(motor, 2.3), 1.0 + 0.3 * 3.0, 1e-14);
    EXPECT_NEAR(motor_target(motor, 5.25), 8.0, 1e-14);
}

// A blow at I / (m l) from the hinge turns the rod about the hinge: nothing across it is left for the hinge to hold.
TEST(JointLaws, ABlowAtTheCenterOfPercussion) {
    constexpr double inertia = (1.0 + 0.01) / 12.0 + 0.25, h = 1e-6;
    for (const double place : {inertia / 0.5, 1.0}) {
        SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi, 1000);
        scene.output.fps = 1000.0;
        scene.simulation.gravity = Vec3::Zero();
        ForceDescription blow;
        blow.point = {place - 0.5, 0.0, 0.0};
        blow.force = {0.0, 1.0 / h, 0.0};  // 1 N s
        blow.end = h;
        scene.forces.push_back(blow);
        World world(scene);
        world.step();
        const JointState hinge = world.joint_states()[0];
        EXPECT_NEAR(hinge.speed[3], place / inertia, 1e-9);
        EXPECT_NEAR(h * hinge.force.y(), 0.5 * place / inertia - 1.0, 1e-9);
    }
}

// Energy falls by the friction torque times the angle, swing by swing.
TEST(JointLaws, FrictionTakesItsTorqueTimesTheAngle) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    scene.simulation.sleep = true;
    scene.joints[0].turn[0].friction = 0.5;
    World world(scene);
    const auto energy = [&] {
        const Measurement m = world.measure();
        return m.kinetic + m.potential;
    };
    const double start = energy();
    double travelled = 0.0, last = world.joint_states()[0].position[3], worst = 0.0;
    for (int step = 0; step < 960 * 2; ++step) {
        world.step();
        const double now = world.joint_states()[0].position[3];
        travelled += std::abs(now - last);
        last = now;
        worst = std::max(worst, std::abs(start - energy() - 0.5 * travelled));
    }
    EXPECT_LT(worst, 0.02);
    run(world, scene, 20.0);
    EXPECT_TRUE(world.snapshot().bodies[0].asleep);
}

TEST(JointLaws, FrictionOfABallActsAgainstItsSpinAboutAnyAxis) {
    SceneDescription scene = empty_scene();
    BodyDescription& cube = add_box(scene, {0.6, 0.6, 0.6}, Vec3::Zero());  // 1 kg: I = 0.06 kg m^2
    const Vec3 spin = Vec3(1.0, 2.0, -2.0) / 3.0;
    cube.angular_velocity = 6.0 * spin;
    JointDescription& ball = add_joint(scene, JointType::ball, std::nullopt, 0, Vec3::Zero());
    for (JointAxis& turn : ball.turn) turn.friction = 0.12;  // 2 rad/s^2
    World world(scene);
    for (int k = 0; k < 60; ++k) world.advance_frame();
    EXPECT_LT((world.snapshot().bodies[0].angular_velocity - 4.0 * spin).norm(), 1e-9);
    for (int k = 0; k < 150; ++k) world.advance_frame();
    EXPECT_LT(world.snapshot().bodies[0].angular_velocity.norm(), 1e-12);
}

// The hinge of a rod from 90 degrees.
TEST(JointLaws, BreaksAtItsStrength) {
    using namespace bench::breaking_pendulum;
    for (const int k : {0, 1, 2}) {
        const bool exact = k > 0;
        SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
        scene.joints[0].break_force = strength;
        if (k == 2) scene.simulation.impacts = ImpactMode::exact;
        if (exact) scene.simulation.integrator = IntegratorKind::exact;
        World world(scene);
        run(world, scene, 1.0);
        const JointState joint = world.joint_states()[0];
        ASSERT_TRUE(joint.broken_at);
        EXPECT_NEAR(*joint.broken_at, time, exact ? 1e-13 : 2.0 / 960.0);
        EXPECT_NEAR(world.snapshot().bodies[0].angular_velocity.z(), -angular_speed, exact ? 1e-11 : 0.03);
    }
}

TEST(JointLaws, LetsGoAtItsTime) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    scene.simulation.sleep = true;
    scene.joints[0].turn[0].motion = JointAxis::Motion::locked;
    scene.joints[0].end = 2.0;
    World world(scene);
    run(world, scene, 1.9);
    EXPECT_TRUE(world.snapshot().bodies[0].asleep);
    EXPECT_NEAR(world.snapshot().bodies[0].center_of_mass.y(), 0.0, 1e-12);
    run(world, scene, 1.1);
    EXPECT_NEAR(world.snapshot().bodies[0].center_of_mass.y(), -0.5 * 9.81, 0.01);
}

TEST(JointLaws, AnAnchorApartIsPulledInWithoutSpeed) {
    SceneDescription scene = empty_scene();
    add_box(scene, {0.2, 0.2, 0.2}, {0.0, 0.0, 0.0});
    add_box(scene, {0.2, 0.2, 0.2}, {0.5, 0.0, 0.0});
    JointDescription& joint = add_joint(scene, JointType::ball, 0, 1, {0.25, 0.0, 0.0});
    joint.anchor_second.x() += 0.02;
    World world(scene);
    double kinetic = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        kinetic = std::max(kinetic, world.measure().kinetic);
    }
    EXPECT_LT(largest_gap(world), 1e-9);
    EXPECT_LT(kinetic, 1e-12);
}

TEST(JointLaws, ATowerOnFixedJointsCarriesAHundredTimesItsWeight) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    for (int i = 0; i < 11; ++i) {
        add_box(scene, {0.2, 0.2, 0.2}, {0.0, 0.1 + 0.2 * i, 0.0}, i == 10 ? 100.0 : 1.0);
        add_joint(scene, JointType::fixed, i == 0 ? std::size_t(0) : std::size_t(i), std::size_t(i + 1),
                  {0.0, 0.2 * i, 0.0});
    }
    scene.simulation.gravity = Vec3(3.0, -9.0, 1.0);
    World world(scene);
    run(world, scene, 2.0);
    double worst = 0.0;
    for (std::size_t i = 1; i < scene.bodies.size(); ++i)
        worst = std::max(worst, (world.snapshot().bodies[i].center_of_mass - scene.bodies[i].position).norm());
    EXPECT_LT(worst, 1e-9);
    EXPECT_TRUE(world.snapshot().bodies[5].asleep);
}

TEST(JointLaws, ADoorWithThreeHingesRests) {
    SceneDescription scene;
    add_box(scene, {0.9, 2.0, 0.04}, {0.45, 0.0, 0.0}, 20.0);
    for (const double y : {-0.8, 0.0, 0.8})
        add_joint(scene, JointType::hinge, std::nullopt, 0, {0.0, y, 0.0}, Vec3::UnitY());
    World world(scene);
    run(world, scene, 2.0);
    const auto joints = world.joint_states();
    EXPECT_NEAR(joints[0].force.x(), -joints[2].force.x(), 1e-6);
    EXPECT_NEAR(joints[0].force.y() + joints[1].force.y() + joints[2].force.y(), 20.0 * 9.81, 1e-6);
    EXPECT_TRUE(world.snapshot().bodies[0].asleep);
}

}  // namespace
}  // namespace tumble::laws_test
