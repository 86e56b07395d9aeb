// Figures with joints of all kinds that sweeps know: conservation laws, sleep, threads, and which groups are swept.
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace tumble::swept_figure_test {
using namespace tumble::testing;

TEST(SweptFigures, AFreeFigureKeepsItsMomentaAndGainsNoEnergy) {
    for (const int steps : {8, 16}) {
        SceneDescription scene = swept(figure_scene(steps));
        scene.simulation.gravity.setZero();
        for (BodyDescription& body : scene.bodies) {
            const Vec3 spin(0.5, 3.0, -1.0);
            body.velocity = Vec3(1.0, 0.5, -2.0) + spin.cross(body.position);
            body.angular_velocity = spin;
        }
        scene.bodies[1].velocity.y() += 3.0;
        scene.bodies[4].velocity.z() += 4.0;
        scene.bodies[4].angular_velocity.y() += 6.0;
        World world(scene);
        const auto start = momenta_of(world);
        double energy = total_energy(world);
        const double first = energy;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            EXPECT_LT(total_energy(world), energy * (1.0 + 1e-9) + 0.01 * energy);
            energy = std::min(energy, total_energy(world));
        }
        const auto end = momenta_of(world);
        EXPECT_LT((end.first - start.first).norm(), 1e-12);
        EXPECT_LT((end.second - start.second).norm(), 1e-11);
        EXPECT_GT(energy, 0.5 * first);
        EXPECT_LT(largest_gap(world), 1e-5);
        EXPECT_EQ(world.joint_report().swept(), 1u);
    }
}

// Figures that lie in a heap fall asleep, and their joints have stayed closed.
TEST(SweptFigures, AHeapOfFiguresFallsAsleep) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 4;
    for (int k = 0; k < 4; ++k) {
        const SceneDescription figure = figure_scene(4);
        const std::size_t first = scene.bodies.size();
        const Quat q = turn(Vec3(1.0, 0.3 * k, -0.5).normalized(), 0.7 * k);
        for (BodyDescription body : figure.bodies) {
            body.position = q * body.position + Vec3(0.3 * k, 0.9 + 0.9 * k, 0.2 * (k % 2));
            body.rotation = q;
            body.friction = 0.5;
            body.restitution = 0.0;
            scene.bodies.push_back(body);
        }
        for (JointDescription joint : figure.joints) {
            *joint.first += first;
            *joint.second += first;
            joint.name += std::to_string(k);
            if (joint.type == JointType::hinge || joint.type == JointType::ball) joint.turn[0].friction = 0.02;
            if (joint.type == JointType::universal)
                for (const std::size_t axis : {0u, 1u}) joint.turn[axis].spring = JointSpring{.damping = 0.1};
            scene.joints.push_back(joint);
        }
    }
    add_floor(scene);
    World world(scene);
    double gap = 0.0, energy = total_energy(world);
    for (int frame = 0; frame < 480; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        EXPECT_LT(total_energy(world), energy + 0.05);
        energy = std::min(energy, total_energy(world));
    }
    const Snapshot s = world.snapshot();
    const auto awake = [](const BodyState& body) { return body.mass > 0.0 && !body.asleep; };
    EXPECT_EQ(std::count_if(s.bodies.begin(), s.bodies.end(), awake), 0);
    EXPECT_LT(gap, 1e-5);
    EXPECT_EQ(world.joint_report().swept(), 4u);
}

// Fast spins, unlike masses and few steps: finite, and without energy from nothing.
TEST(SweptFigures, AWildFigureStaysFinite) {
    SceneDescription scene = swept(figure_scene(1));
    scene.bodies[0].mass = 100.0;
    scene.bodies[2].mass = 0.05;
    scene.bodies[3].mass = 20.0;
    scene.bodies[1].angular_velocity = {50.0, -80.0, 120.0};
    scene.bodies[3].angular_velocity = {0.0, 60.0, 0.0};
    scene.bodies[4].angular_velocity = {-70.0, 0.0, 200.0};
    scene.bodies[4].velocity = {20.0, 5.0, -30.0};
    for (BodyDescription& body : scene.bodies) body.position.y() += 1.0;
    add_floor(scene);
    World world(scene);
    const double start = total_energy(world);
    double most = start;
    for (int frame = 0; frame < 240; ++frame) {
        world.advance_frame();
        most = std::max(most, total_energy(world));
    }
    EXPECT_LT(most, 1.001 * start);
    EXPECT_LT(largest_gap(world), 0.1);
}

TEST(SweptFigures, HaveTheSameBytesForAnyThreads) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 1;
    for (int k = 0; k < 160; ++k) {
        const SceneDescription figure = figure_scene(1);
        const std::size_t first = scene.bodies.size();
        for (BodyDescription body : figure.bodies) {
            body.position += Vec3(0.9 * (k % 16), 0.8, 0.9 * (k / 16));
            body.angular_velocity = {0.1 * k, 1.0, 0.3};
            scene.bodies.push_back(body);
        }
        for (JointDescription joint : figure.joints) {
            *joint.first += first;
            *joint.second += first;
            joint.name += std::to_string(k);
            scene.joints.push_back(joint);
        }
    }
    add_floor(scene);
    World one(scene, 1), two(scene, 2);
    for (int frame = 0; frame < 40; ++frame) {
        one.advance_frame();
        two.advance_frame();
    }
    const Snapshot a = one.snapshot(), b = two.snapshot();
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        EXPECT_EQ(a.bodies[i].momentum, b.bodies[i].momentum) << i;
        EXPECT_EQ(a.bodies[i].orientation.coeffs(), b.bodies[i].orientation.coeffs()) << i;
    }
}

// Which groups the sweeps take where they are asked to take all.
TEST(SweptFigures, LeaveOtherJointsToTheDirectSolver) {
    const auto by_sweeps = [](auto&& change) {
        SceneDescription scene = swept(figure_scene(4));
        change(scene);
        return World(scene).joint_report().swept();
    };
    EXPECT_EQ(by_sweeps([](SceneDescription&) {}), 1u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].friction = 0.1; }), 1u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].spring = JointSpring{.damping = 0.1}; }), 1u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].spring = JointSpring{.stiffness = 1.0}; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].restitution = 0.5; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].motor.emplace().speed = 1.0; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[1].break_torque = 10.0; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[1].move[0].motion = JointAxis::Motion::free; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[2].turn[0].friction = s.joints[2].turn[1].friction = 0.1; }),
              0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.simulation.contact_solver = ContactSolverChoice::by_island; }), 0u);
}

}  // namespace tumble::swept_figure_test
