// Joints that lock or limit turns, solved in sweeps: against closed forms, the direct solver, and by conservation laws.
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::sweep_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

// Largest angle between the twist axes of a ball's frames.
double swing_of(const World& world, const JointDescription& joint) {
    const Snapshot s = world.snapshot();
    const auto axis = [&](std::size_t body, const Quat& frame) {
        return Vec3(s.bodies[body].orientation * (frame * Vec3::UnitX()));
    };
    const Vec3 a = axis(*joint.first, joint.frame_first), b = axis(*joint.second, joint.frame_second);
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Joint frames are given from the body's origin, which is the center of mass of a box.
double twist_of(const World& world, std::size_t joint) { return world.joint_states()[joint].position[3]; }

}  // namespace

// T = 4 sqrt(2 l / (3 g)) K(sin(a / 2)) of a rod that swings by a = 60 degrees: K(1/2) = 1.68575035481260.
TEST(SweptTurns, ARodSwingsOnAHinge) {
    SceneDescription scene = swept(pendulum_scene(std::numbers::pi / 3.0));
    scene.simulation.gravity.z() = 3.0;  // the hinge carries it
    World world(scene);
    const double quarter = std::sqrt(2.0 / (3.0 * g)) * 1.68575035481260;
    double low = 0.0, gap = 0.0;
    for (int step = 1; step <= 960 && low == 0.0; ++step) {
        world.step();
        gap = std::max(gap, largest_gap(world));
        if (world.snapshot().bodies[0].center_of_mass.x() < 0.0) low = step / 960.0;
    }
    EXPECT_NEAR(low, quarter, 3e-3);
    EXPECT_LT(gap, 1e-4);
    EXPECT_GT(world.joint_report().swept(), 0u);  // otherwise it was solved directly
    EXPECT_LT(std::abs(world.snapshot().bodies[0].center_of_mass.z()), 1e-4);
}

// A chain of eight plates on hinges swings down from its end, in sweeps as with the direct solver.
TEST(SweptTurns, AHingeChainSwingsAsWithTheDirectSolver) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    scene.simulation.sleep = false;
    scene.simulation.gravity.z() = 1.0;  // the hinges carry it
    for (int i = 0; i < 8; ++i) {
        add_box(scene, {0.5, 0.1, 0.4}, {0.25 + 0.5 * i, 0.0, 0.0});
        const auto before = i == 0 ? std::optional<std::size_t>{} : std::size_t(i - 1);
        add_joint(scene, JointType::hinge, before, std::size_t(i), {0.5 * i, 0.0, 0.0}, Vec3::UnitZ());
    }
    World sweeps(scene);
    scene.simulation.contact_solver = ContactSolverChoice::direct;
    World direct(scene);
    double off = 0.0, gap = 0.0, across = 0.0;
    for (int frame = 0; frame < 50; ++frame) {
        sweeps.advance_frame();
        direct.advance_frame();
        gap = std::max(gap, largest_gap(sweeps));
        const Snapshot a = sweeps.snapshot(), b = direct.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i) {
            off = std::max(off, (a.bodies[i].center_of_mass - b.bodies[i].center_of_mass).norm());
            across = std::max(across, std::abs(a.bodies[i].center_of_mass.z()));
        }
    }
    EXPECT_LT(off, 0.1);  // of 4 m
    EXPECT_LT(gap, 4e-3);
    EXPECT_GT(sweeps.joint_report().swept(), 0u);
    EXPECT_LT(across, 1e-2);
}

// Four boxes of 1 kg and 0.5 m, welded to each other and to the world: 4 m g, and the moment 4 m g at 1 m.
TEST(SweptTurns, AWeldedBeamCarriesItsWeight) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    for (int i = 0; i < 4; ++i) {
        add_box(scene, {0.5, 0.2, 0.2}, {0.25 + 0.5 * i, 0.0, 0.0});
        const auto before = i == 0 ? std::optional<std::size_t>{} : std::size_t(i - 1);
        add_joint(scene, JointType::fixed, before, std::size_t(i), {0.5 * i, 0.0, 0.0}, Vec3::UnitX());
    }
    World world(scene);
    run(world, scene, 1.0);
    const JointState joint = world.joint_states()[0];
    EXPECT_NEAR(joint.force.y(), 4.0 * g, 0.02 * 4.0 * g);
    EXPECT_NEAR(joint.torque.z(), 4.0 * g, 0.02 * 4.0 * g);
    EXPECT_LT(largest_gap(world), 1e-4);
    EXPECT_GT(world.joint_report().swept(), 0u);
    EXPECT_LT(std::abs(world.snapshot().bodies[3].center_of_mass.y()), 1e-3);
    run(world, scene, 1.0);
    EXPECT_TRUE(world.snapshot().bodies[3].asleep);
}

TEST(SweptTurns, ADoorStopsAtItsLimit) {
    for (const int steps : {1, 8}) {
        SceneDescription scene = swept({});
        scene.simulation.steps_per_frame = steps;
        scene.simulation.gravity.setZero();
        scene.simulation.sleep = false;
        BodyDescription& door = add_box(scene, {0.9, 2.0, 0.04}, {0.45, 0.0, 0.0}, 20.0);
        door.angular_velocity = {0.0, 3.0, 0.0};
        door.velocity = door.angular_velocity.cross(door.position);
        limit_turn(add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY()).turn[0], -1.0, 1.0);
        World world(scene);
        double farthest = 0.0;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            farthest = std::max(farthest, twist_of(world, 0));
        }
        EXPECT_LT(farthest, 1.0 + 2e-3);
        EXPECT_NEAR(twist_of(world, 0), 1.0, 2e-3);
        EXPECT_LT(world.measure().kinetic, 1e-4);
    }
}

// A rod falls on a ball joint until its axis is 0.5 rad from the vertical, and moves round along the cone's border.
TEST(SweptTurns, AConeAndATwistHold) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 4;
    scene.simulation.sleep = false;
    BodyDescription& base = add_box(scene, {0.2, 0.2, 0.2}, Vec3::Zero());
    base.type = BodyType::fixed;
    BodyDescription& rod = add_box(scene, {0.1, 1.0, 0.2}, {0.0, 0.5, 0.0});
    rod.angular_velocity = {1.0, 8.0, 0.5};
    rod.velocity = rod.angular_velocity.cross(rod.position);
    JointDescription& ball = add_joint(scene, JointType::ball, 0, 1, Vec3::Zero(), Vec3::UnitY());
    ball.swing = {0.5, 0.5};
    limit_turn(ball.turn[0], -0.3, 0.2);
    World world(scene);
    double swing = 0.0, twist = 0.0, other = 0.0;
    for (int frame = 0; frame < 120; ++frame) {
        world.advance_frame();
        swing = std::max(swing, swing_of(world, scene.joints[0]));
        twist = std::max(twist, twist_of(world, 0));
        other = std::min(other, twist_of(world, 0));
    }
    EXPECT_LT(swing, 0.5 + 5e-3);
    EXPECT_GT(swing, 0.5);
    EXPECT_NEAR(twist, 0.2, 2e-3);
    EXPECT_GT(other, -0.3 - 2e-3);
    EXPECT_NEAR(swing_of(world, scene.joints[0]), 0.5, 2e-3);
    EXPECT_LT(largest_gap(world), 1e-3);
}

// Both angles turn by a radian and more; the third direction stays locked.
TEST(SweptTurns, AUniversalJointTurnsAboutBothAxes) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    scene.simulation.gravity.setZero();
    BodyDescription& plate = add_box(scene, {0.8, 0.6, 0.1}, Vec3::Zero());
    plate.angular_velocity = {3.0, 2.0, 0.0};
    add_joint(scene, JointType::universal, std::nullopt, 0, Vec3::Zero(), Vec3::UnitX());
    World world(scene);
    double gap = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
    }
    EXPECT_LT(gap, 1e-3);
    EXPECT_GT(world.joint_report().swept(), 0u);
    const JointState joint = world.joint_states()[0];
    EXPECT_GT(std::abs(joint.position[3]), 1.0);
    EXPECT_GT(std::abs(joint.position[4]), 1.0);
    EXPECT_GT(world.measure().kinetic, 0.9 * 0.5 * (0.0308333 * 9.0 + 0.0541667 * 4.0));
}

// I w' = -C w, and I w' = -tau: exp(-t C / I), and 1 - t tau / (I w) of the speed.
TEST(SweptTurns, DampersAndFrictionSlowARotor) {
    for (const bool ball : {false, true})
        for (const bool damper : {false, true}) {
            SceneDescription scene = swept({});
            scene.simulation.steps_per_frame = 8;
            scene.simulation.gravity.setZero();
            const double inertia = 0.1 * 4.0 * 0.5 * 0.5;  // 2/5 m r^2
            BodyDescription& rotor = add_sphere(scene, 0.5, Vec3::Zero(), 1.0);
            const Vec3 axis = ball ? Vec3(2.0, -1.0, 2.0) / 3.0 : Vec3(Vec3::UnitZ());
            rotor.angular_velocity = 10.0 * axis;
            JointDescription& joint = add_joint(scene, ball ? JointType::ball : JointType::hinge, std::nullopt, 0,
                                                Vec3::Zero(), Vec3::UnitZ());
            if (damper) {
                joint.turn[0].spring.emplace();
                joint.turn[0].spring->damping = 0.05;
            } else {
                joint.turn[0].friction = 0.5;
            }
            World world(scene);
            run(world, scene, 1.0);
            const Vec3 left = world.snapshot().bodies[0].angular_velocity;
            const double expected = damper ? 10.0 * std::exp(-0.05 / inertia) : 10.0 - 0.5 / inertia;
            EXPECT_NEAR(left.dot(axis), expected, 0.01 * expected) << ball << damper;
            EXPECT_LT(left.cross(axis).norm(), 1e-4);
            EXPECT_NEAR(world.joint_states()[0].torque.dot(axis), damper ? -0.05 * expected : -0.5, 0.01);
            run(world, scene, 2.0);
            const double late = damper ? 10.0 * std::exp(-0.15 / inertia) : 0.0;
            EXPECT_NEAR(world.snapshot().bodies[0].angular_velocity.norm(), late, 0.03 * late + 1e-6);
        }
}

// A paddle turns by 1.5 rad in a second, and two vanes on hinges and a weld go along.
TEST(SweptTurns, FollowAKinematicBody) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    BodyDescription& paddle = add_box(scene, {0.4, 0.2, 0.4}, Vec3::Zero());
    paddle.type = BodyType::kinematic;
    paddle.keyframes = {{0.0, Vec3::Zero(), Quat::Identity()}, {1.0, {0.3, 0.2, 0.0}, turn(Vec3::UnitY(), 1.5)}};
    add_box(scene, {0.4, 0.2, 0.1}, {0.4, 0.0, 0.0});
    add_joint(scene, JointType::hinge, 0, 1, {0.2, 0.0, 0.0}, Vec3::UnitY());
    add_box(scene, {0.4, 0.2, 0.1}, {-0.4, 0.0, 0.0});
    add_joint(scene, JointType::fixed, 0, 2, {-0.2, 0.0, 0.0}, Vec3::UnitY());
    World world(scene);
    double gap = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
    }
    EXPECT_LT(gap, 5e-3);
    EXPECT_GT(world.joint_report().swept(), 0u);
    const Vec3 vane = world.snapshot().bodies[2].center_of_mass;
    EXPECT_LT((vane - Vec3(0.3 - 0.4 * std::cos(1.5), 0.2, 0.4 * std::sin(1.5))).norm(), 5e-3);
}

}  // namespace tumble::sweep_test
