// Gears: theta_1 + ratio theta_2 = constant, against closed forms and conservation laws.
#include "joint_scenes.h"
#include "sim/checkpoint/archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::gear_test {
using namespace tumble::testing;

namespace {

constexpr double ratio = 2.5;

JointDescription& add_gear(SceneDescription& scene, std::size_t first, std::size_t second, double of_ratio) {
    JointDescription gear;
    gear.name = "gear";
    gear.type = JointType::gear;
    gear.geared = {first, second};
    gear.ratio = of_ratio;
    scene.joints.push_back(gear);
    return scene.joints.back();
}

double inertia_about_z(const Vec3& size, double mass) {
    return mass / 12.0 * (size.x() * size.x() + size.y() * size.y());
}
constexpr double mass_1 = 3.0, mass_2 = 8.0;
const Vec3 size_1{0.4, 0.2, 0.1}, size_2{0.5, 0.5, 0.2};
const double inertia_1 = inertia_about_z(size_1, mass_1), inertia_2 = inertia_about_z(size_2, mass_2);

/// Two wheels on axles in the world along z, with a gear between them.
SceneDescription wheels_scene(int steps_per_frame = 16) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.sleep = false;
    add_box(scene, size_1, {0.0, 0.0, 0.0}, mass_1);
    add_box(scene, size_2, {2.0, 1.0, 0.5}, mass_2);
    for (std::size_t i = 0; i < 2; ++i)
        add_joint(scene, JointType::hinge, std::nullopt, i, scene.bodies[i].position, Vec3::UnitZ());
    add_gear(scene, 0, 1, ratio);
    return scene;
}

JointMotor constant_torque(double torque) {
    JointMotor motor;
    motor.speed = 1e6;
    motor.max_force = torque;
    return motor;
}

// (I1 + I2 / k^2) omega_1' = T, and omega_2 = -omega_1 / k; both wheels turn many times.
TEST(Gears, TwoFlywheelsUnderAConstantTorque) {
    constexpr double torque = 40.0;
    SceneDescription scene = wheels_scene();
    scene.joints[0].turn[0].motor = constant_torque(torque);
    World world(scene);
    const double rate = torque / (inertia_1 + inertia_2 / (ratio * ratio)), h = scene.step();
    double gap = 0.0;
    for (int step = 1; step <= 3 * 960; ++step) {
        world.step();
        const auto joints = world.joint_states();
        ASSERT_NEAR(joints[0].speed[3], rate * step * h, 1e-10 * rate);
        ASSERT_NEAR(joints[1].speed[3], -rate * step * h / ratio, 1e-10 * rate);
        gap = std::max(gap, joints[2].gap);
        ASSERT_NEAR(joints[0].position[3], 0.5 * rate * h * h * step * step, 1e-9 * rate);
    }
    const auto joints = world.joint_states();
    EXPECT_GT(joints[0].position[3], 20.0 * std::numbers::pi);
    EXPECT_NEAR(joints[0].position[3] + ratio * joints[1].position[3], 0.0, 1e-11);
    EXPECT_LT(gap, 1e-11);
    EXPECT_NEAR(joints[2].torque.z(), -rate * inertia_2 / (ratio * ratio), 1e-8 * torque);
}

// x + r theta = constant, with r in m/rad: (m + I / r^2) x'' = -m g.
TEST(Gears, AFallingRackTurnsItsPinion) {
    constexpr double radius = 0.15;
    SceneDescription scene;
    scene.simulation.sleep = false;
    add_box(scene, {0.1, 1.0, 0.1}, {0.15, 0.0, 0.0}, 2.0);
    add_box(scene, size_2, {0.0, 0.0, 0.0}, mass_2);
    add_joint(scene, JointType::slider, std::nullopt, 0, scene.bodies[0].position, Vec3::UnitY());
    add_joint(scene, JointType::hinge, std::nullopt, 1, Vec3::Zero(), Vec3::UnitZ());
    add_gear(scene, 0, 1, -radius);
    SceneDescription turned = scene;  // the same in the other order: theta - x / r
    turned.joints[2].geared = {1, 0};
    turned.joints[2].ratio = -1.0 / radius;
    const double rate = -9.81 * 2.0 / (2.0 + inertia_2 / (radius * radius));
    for (const SceneDescription& one : {scene, turned}) {
        World world(one);
        run(world, one, 2.0);
        const auto joints = world.joint_states();
        EXPECT_NEAR(joints[0].speed[0], 2.0 * rate, 1e-10);
        EXPECT_NEAR(joints[1].speed[3], 2.0 * rate / radius, 1e-9);
        EXPECT_LT(joints[1].position[3], -2.0 * std::numbers::pi);
        EXPECT_LT(joints[2].gap, 1e-12);
        const Measurement m = world.measure();
        EXPECT_NEAR(m.kinetic + m.potential, 0.0, 1e-9);
    }
}

// Four bodies in space: equal and opposite for each joint.
TEST(Gears, KeepMomentumAndEnergyInSpace) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3::Zero();
    scene.simulation.steps_per_frame = 16;
    scene.simulation.sleep = false;
    for (int i = 0; i < 4; ++i) {
        BodyDescription& box = add_box(scene, {0.5 + 0.1 * i, 0.3, 0.4}, {1.5 * i, 0.2 * i, 0.0}, 1.0 + i);
        box.velocity = {0.1 * i, 0.05, -0.1};
    }
    const Vec3 first_axis = Vec3(0.3, 1.0, 0.2), second_axis = Vec3(1.0, -0.4, 0.5);
    scene.bodies[1].velocity = scene.bodies[0].velocity;
    scene.bodies[3].velocity = scene.bodies[2].velocity;
    scene.bodies[1].angular_velocity = 3.0 * first_axis.normalized();
    scene.bodies[3].angular_velocity = -3.0 / ratio * second_axis.normalized();
    add_joint(scene, JointType::hinge, 0, 1, scene.bodies[1].position, first_axis);
    add_joint(scene, JointType::hinge, 2, 3, scene.bodies[3].position, second_axis);
    add_gear(scene, 0, 1, ratio);
    World world(scene);
    const Measurement start = world.measure();
    double change = 0.0, gap = 0.0;
    for (int step = 0; step < 5 * 960; ++step) {
        world.step();
        const Measurement now = world.measure();
        change = std::max(change, std::abs(now.kinetic - start.kinetic));
        gap = std::max(gap, largest_gap(world));
        ASSERT_LT((now.momentum - start.momentum).norm(), 1e-12);
        ASSERT_LT((now.angular_momentum - start.angular_momentum).norm(), 1e-11);
    }
    EXPECT_LT(change, 5e-3 * start.kinetic);
    EXPECT_LT(gap, 1e-12);
    EXPECT_GT(std::abs(world.joint_states()[0].position[3]), std::numbers::pi);
}

// A gear that begins to hold is a clutch: J = -(w1 + k w2) / (1/I1 + k^2/I2), and the lost energy is in the table.
TEST(Gears, AClutchEngagesWithAnImpulse) {
    SceneDescription scene = wheels_scene();
    scene.joints[2].start = 0.5;
    scene.bodies[0].angular_velocity = {0.0, 0.0, 6.0};
    World world(scene);
    run(world, scene, 0.5);
    EXPECT_FALSE(world.joint_states()[2].active);
    EXPECT_NEAR(world.joint_states()[0].position[3], 3.0, 1e-10);
    run(world, scene, 1.0);
    const auto joints = world.joint_states();
    const double impulse = -6.0 / (1.0 / inertia_1 + ratio * ratio / inertia_2);
    EXPECT_TRUE(joints[2].active);
    EXPECT_NEAR(joints[0].speed[3], 6.0 + impulse / inertia_1, 1e-10);
    EXPECT_NEAR(joints[1].speed[3], ratio * impulse / inertia_2, 1e-10);
    EXPECT_LT(joints[2].gap, 1e-12);
}

TEST(Gears, BreakAtTheirStrengthAndWithTheirJoints) {
    SceneDescription scene = wheels_scene();
    const double torque = 40.0, load = torque / (inertia_1 + inertia_2 / (ratio * ratio)) * inertia_2 / (ratio * ratio);
    scene.joints[0].turn[0].motor = constant_torque(torque);
    scene.joints[2].break_torque = 1.01 * load;
    World holds(scene);
    run(holds, scene, 0.5);
    EXPECT_TRUE(holds.joint_states()[2].active);
    scene.joints[2].break_torque = 0.99 * load;
    World breaks(scene);
    run(breaks, scene, 0.5);
    EXPECT_TRUE(breaks.joint_states()[2].broken_at.has_value());
    EXPECT_NEAR(breaks.joint_states()[0].speed[3], torque / inertia_1 * 0.5, torque / inertia_1 * 1.1 / 960.0);

    SceneDescription ends = wheels_scene();
    ends.joints[1].end = 0.25;
    ends.simulation.gravity = Vec3::Zero();
    ends.joints[0].turn[0].motor = constant_torque(torque);
    World world(ends);
    run(world, ends, 0.5);
    EXPECT_FALSE(world.joint_states()[2].active);
    EXPECT_GT(world.joint_states()[0].speed[3], 0.3 * torque / inertia_1);
}

TEST(Gears, CountAsOneRow) {
    const SceneDescription scene = wheels_scene();
    const JointReport report = World(scene).joint_report();
    EXPECT_EQ(report.rows, 11u);
    EXPECT_EQ(report.redundant, 0u);
    EXPECT_EQ(report.degrees_of_freedom, 1u);
    EXPECT_EQ(report.groups, 1u);
    EXPECT_EQ(report.trees, 1u);
    EXPECT_EQ(report.loops, 0u);
    SceneDescription twice = scene;  // a second gear of the same ratio says nothing new
    add_gear(twice, 1, 0, 1.0 / ratio);
    EXPECT_EQ(World(twice).joint_report().redundant, 1u);
    EXPECT_EQ(World(twice).joint_report().degrees_of_freedom, 1u);
}

// Three wheels with three gears, one too many.
TEST(Gears, RingsOfGearsAreRedundantAndHold) {
    SceneDescription scene = wheels_scene();
    add_box(scene, size_1, {-2.0, 0.0, 0.0}, mass_1);
    add_joint(scene, JointType::hinge, std::nullopt, 2, scene.bodies[2].position, Vec3::UnitZ());
    add_gear(scene, 1, 3, 1.0 / ratio);
    add_gear(scene, 0, 3, -1.0);
    scene.joints[0].turn[0].motor = constant_torque(40.0);
    World world(scene);
    run(world, scene, 1.0);
    const double rate = 40.0 / (2.0 * inertia_1 + inertia_2 / (ratio * ratio));
    EXPECT_NEAR(world.joint_states()[3].speed[3], rate, 1e-8 * rate);
    EXPECT_LT(largest_gap(world), 1e-11);
}

// Sun, planet and carrier in a fixed ring (Willis 1841): the sun turns 1 + z_ring / z_sun times as fast as the carrier.
TEST(Gears, APlanetaryGearFollowsWillis) {
    constexpr double sun = 20.0, planet = 15.0, ring = sun + 2.0 * planet, torque = 5.0;  // teeth; N m
    SceneDescription scene = empty_scene();
    scene.simulation.steps_per_frame = 16;
    scene.simulation.sleep = false;
    add_box(scene, size_1, Vec3::Zero(), 2.0);          // carrier
    add_box(scene, size_2, Vec3::Zero(), 1.0);          // sun
    add_box(scene, size_1, Vec3(0.35, 0.0, 0.0), 0.5);  // planet
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 0, 1, Vec3::Zero(), Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 0, 2, scene.bodies[2].position, Vec3::UnitZ());
    scene.joints[0].turn[0].motor = constant_torque(torque);
    add_gear(scene, 1, 2, planet / sun);
    add_gear(scene, 0, 2, planet / ring);
    World world(scene);
    run(world, scene, 2.0);
    const double of_sun = 1.0 + ring / sun, of_planet = 1.0 - ring / planet;
    const double inertia = inertia_about_z(size_1, 2.0) + of_sun * of_sun * inertia_about_z(size_2, 1.0) +
                           of_planet * of_planet * inertia_about_z(size_1, 0.5) + 0.5 * 0.35 * 0.35;
    const double speed = 2.0 * torque / inertia;
    const Snapshot now = world.snapshot();
    EXPECT_NEAR(world.joint_states()[0].speed[3], speed, 1e-4 * speed);
    EXPECT_NEAR(now.bodies[1].angular_velocity.z(), of_sun * world.joint_states()[0].speed[3], 1e-9 * speed);
    EXPECT_NEAR(now.bodies[2].angular_velocity.z(), of_planet * world.joint_states()[0].speed[3], 1e-9 * speed);
    EXPECT_LT(largest_gap(world), 1e-11);
    EXPECT_EQ(world.joint_report().degrees_of_freedom, 1u);
}

/// A ball of 0.5 kg on its way to the first wheel, 0.15 m beside the axle.
BodyDescription& add_striking_ball(SceneDescription& scene, double speed) {
    BodyDescription& ball = add_sphere(scene, 0.05, {0.15, 0.35, 0.0}, 0.5);
    ball.velocity = {0.0, -speed, 0.0};
    ball.friction = 0.0;
    return ball;
}

// A blow on one wheel turns both: p = (1 + e) v / (1 / m + d^2 / I), I = I1 + I2 / k^2.
TEST(Gears, ABlowOnOneWheelTurnsBoth) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact})
        for (const double e : {0.6, 1.0}) {
            SceneDescription scene = wheels_scene();
            scene.simulation.gravity.setZero();
            scene.simulation.impacts = mode;
            for (BodyDescription& wheel : scene.bodies) wheel.restitution = e;
            add_striking_ball(scene, 3.0).restitution = 0.0;
            World world(scene);
            for (int frame = 0; frame < 5; ++frame) world.advance_frame();
            const double both = inertia_1 + inertia_2 / (ratio * ratio), arm = 0.15;
            const double blow = (1.0 + e) * 3.0 / (1.0 / 0.5 + arm * arm / both), spin = -blow * arm / both;
            const Snapshot snapshot = world.snapshot();
            EXPECT_NEAR(inertia_1 * snapshot.bodies[0].angular_velocity.z(), inertia_1 * spin, 1e-12) << e;
            EXPECT_NEAR(inertia_2 * snapshot.bodies[1].angular_velocity.z(), -inertia_2 * spin / ratio, 1e-12);
            EXPECT_NEAR(snapshot.bodies[2].velocity.y(), -3.0 + blow / 0.5, 1e-12);
            EXPECT_NEAR(world.measure().kinetic,
                        0.25 * 9.0 - 0.25 * (1.0 - e * e) * 9.0 / (1.0 + 0.5 * arm * arm / both), 1e-12);
        }
}

// The wheels of a free carrier: a blow keeps the momenta of all, and the relation of the gear.
TEST(Gears, ABlowOnAFreeGearboxKeepsMomenta) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = empty_scene();
        scene.simulation.impacts = mode;
        scene.simulation.sleep = false;
        add_box(scene, size_1, Vec3::Zero(), mass_1);
        add_box(scene, size_2, {0.6, 0.0, 0.0}, mass_2);
        add_box(scene, {1.2, 0.05, 0.1}, {0.3, 0.0, 0.0}, 4.0);
        for (std::size_t i = 0; i < 2; ++i)
            add_joint(scene, JointType::hinge, 2, i, scene.bodies[i].position, Vec3::UnitZ());
        add_gear(scene, 0, 1, ratio);
        for (BodyDescription& body : scene.bodies) body.restitution = 1.0;
        add_striking_ball(scene, 3.0);
        World world(scene);
        const Measurement before = world.measure();
        for (int frame = 0; frame < 5; ++frame) world.advance_frame();
        const Measurement after = world.measure();
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-13);
        EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-13);
        EXPECT_NEAR(after.kinetic, before.kinetic, 1e-4);  // of the steps after the blow
        const auto joints = world.joint_states();
        EXPECT_GT(std::abs(joints[0].speed[3]), 1.0);
        EXPECT_NEAR(joints[0].speed[3] + ratio * joints[1].speed[3], 0.0, 1e-10);
    }
}

// A world restored in the middle goes on to the last byte: the constant of a gear is kept.
TEST(Gears, ACheckpointGoesOn) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = wheels_scene();
        scene.simulation.impacts = mode;
        scene.joints[0].turn[0].motor = constant_torque(3.0);
        scene.joints[2].start = 0.2;  // engages at the angles of that time
        add_striking_ball(scene, 1.0).restitution = 0.5;
        World whole(scene);
        CheckpointWriter middle, end;
        for (int frame = 0; frame < 60; ++frame) {
            if (frame == 30) whole.save(middle);
            whole.advance_frame();
        }
        whole.save(end);
        World part(scene);
        CheckpointReader reader(middle.bytes());
        part.restore(reader);
        for (int frame = 30; frame < 60; ++frame) part.advance_frame();
        CheckpointWriter again;
        part.save(again);
        EXPECT_TRUE(std::ranges::equal(end.bytes(), again.bytes()));
        EXPECT_LT(part.joint_states()[2].gap, 1e-11);
    }
}

}  // namespace
}  // namespace tumble::gear_test
