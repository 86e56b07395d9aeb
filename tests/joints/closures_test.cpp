// Loops of joints, gears and rods in flight, in coordinates of a spanning tree, against closed forms and conservation
// laws.
#include "core/deterministic_math.h"
#include "joint_scenes.h"
#include "tree_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::closures_test {
using namespace tumble::testing;

namespace {

/// Two upright cranks of 1 m and a coupler, thin rods of 1 kg, without gravity: the coupler does not turn, and the
/// inertia about the angle of a crank is that of both cranks about their ends and m r^2 of the coupler.
constexpr double crank_inertia = 2.0 * (1.0 / 3.0 + 1e-6 / 12.0) + 1.0;

SceneDescription parallelogram(double speed) {
    SceneDescription scene;
    scene.simulation.gravity.setZero();
    scene.simulation.sleep = false;
    scene.simulation.steps_per_frame = 2;
    const Vec3 rod{1.0, 1e-3, 1e-3};
    for (int i = 0; i < 2; ++i) {
        BodyDescription& crank = add_box(scene, rod, {double(i), 0.5, 0.0});
        crank.rotation = turn(Vec3::UnitZ(), 0.5 * pi);
        crank.velocity = {-0.5 * speed, 0.0, 0.0};
        crank.angular_velocity = {0.0, 0.0, speed};
        add_joint(scene, JointType::hinge, std::nullopt, std::size_t(i), {double(i), 0.0, 0.0}, Vec3::UnitZ());
    }
    add_box(scene, rod, {0.5, 1.0, 0.0}).velocity = {-speed, 0.0, 0.0};
    add_joint(scene, JointType::hinge, 0, 2, {0.0, 1.0, 0.0}, Vec3::UnitZ());
    add_joint(scene, JointType::hinge, 1, 2, {1.0, 1.0, 0.0}, Vec3::UnitZ());
    return scene;
}

double angle_after(SceneDescription scene, double time, int steps, IntegratorKind integrator, double* gap = nullptr) {
    scene.simulation.integrator = integrator;
    scene.output.fps = 1.0 / time;
    scene.simulation.steps_per_frame = steps;
    World world(scene);
    for (int i = 0; i < steps; ++i) {
        world.step();
        if (gap) *gap = std::max(*gap, largest_gap(world));
    }
    return world.joint_states()[0].position[3];
}

/// Angle of I q'' = -k q - c q' from 0 at a speed.
double swing(double inertia, double k, double c, double speed, double t) {
    const double decay = 0.5 * c / inertia, rate = std::sqrt(k / inertia - decay * decay);
    return speed / rate * std::exp(-decay * t) * std::sin(rate * t);
}

TEST(Closures, ADampedLoopToSecondOrder) {
    SceneDescription scene = parallelogram(2.0);
    scene.joints[0].turn[0].spring = JointSpring{.stiffness = 20.0, .damping = 3.0};
    const double expected = swing(crank_inertia, 20.0, 3.0, 2.0, 1.0);
    double gap = 0.0;
    const double coarse = angle_after(scene, 1.0, 60, IntegratorKind::symplectic_euler, &gap) - expected;
    const double fine = angle_after(scene, 1.0, 120, IntegratorKind::symplectic_euler, &gap) - expected;
    EXPECT_LT(std::abs(fine), 1e-4);
    EXPECT_NEAR(coarse / fine, 4.0, 0.1);
    EXPECT_LT(gap, 1e-13);
    EXPECT_NEAR(angle_after(scene, 1.0, 60, IntegratorKind::exact), expected, 1e-9);
    EXPECT_NEAR(angle_after(scene, 1.0, 240, IntegratorKind::runge_kutta_4), expected, 1e-7);
    EXPECT_NEAR(angle_after(scene, 1.0, 240, IntegratorKind::splitting), expected, 1e-7);
}

// Two wheels on the ground with a gear, and a spring on the first: I = I1 + I2 / k^2.
TEST(Closures, AGearTrainToSecondOrder) {
    SceneDescription scene = empty_scene();
    scene.simulation.sleep = false;
    const Vec3 small{0.4, 0.2, 0.1}, large{0.5, 0.5, 0.2};
    add_box(scene, small, Vec3::Zero(), 3.0).angular_velocity = {0.0, 0.0, 2.0};
    add_box(scene, large, {2.0, 1.0, 0.5}, 8.0).angular_velocity = {0.0, 0.0, -0.8};
    for (std::size_t i = 0; i < 2; ++i)
        add_joint(scene, JointType::hinge, std::nullopt, i, scene.bodies[i].position, Vec3::UnitZ());
    scene.joints[0].turn[0].spring = JointSpring{.stiffness = 4.0};
    JointDescription gear;
    gear.name = "gear";
    gear.type = JointType::gear;
    gear.geared = {0, 1};
    gear.ratio = 2.5;
    scene.joints.push_back(gear);
    const double inertia = 3.0 / 12.0 * (0.16 + 0.04) + 8.0 / 12.0 * 0.5 / 6.25;
    const double expected = swing(inertia, 4.0, 0.0, 2.0, 1.0);
    double gap = 0.0;
    const double coarse = angle_after(scene, 1.0, 120, IntegratorKind::symplectic_euler, &gap) - expected;
    const double fine = angle_after(scene, 1.0, 240, IntegratorKind::symplectic_euler, &gap) - expected;
    EXPECT_LT(std::abs(fine), 1e-3);
    EXPECT_NEAR(coarse / fine, 4.0, 0.1);
    EXPECT_LT(gap, 1e-13);
    EXPECT_NEAR(angle_after(scene, 1.0, 60, IntegratorKind::exact), expected, 1e-9);
    World world(scene);
    const auto energy = [&] {
        const Measurement m = world.measure();
        return m.kinetic + m.potential + m.elastic;
    };
    const double start = energy();
    double early = 0.0, late = 0.0;
    for (int step = 0; step < 9600; ++step) {
        world.step();
        double& worst = step < 960 ? early : late;
        worst = std::max(worst, std::abs(energy() - start));
    }
    EXPECT_LT(early, 2e-2 * start);
    EXPECT_LT(late, 1.01 * early);
}

// It slows down evenly and stays: I q'^2 / 2 = torque q.
TEST(Closures, FrictionInALoopStopsIt) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription scene = parallelogram(1.2);
        scene.joints[0].turn[0].friction = 2.0;
        scene.simulation.integrator = integrator;
        World world(scene);
        world.record_contacts();
        const double start = world.measure().kinetic;
        for (int frame = 0; frame < 120; ++frame) {
            world.advance_frame();
            const Measurement m = world.measure();
            ASSERT_NEAR(m.kinetic + world.contact_records().energy.joint_heat, start, 1e-9) << frame;
        }
        EXPECT_NEAR(start, 0.5 * crank_inertia * 1.44, 1e-12);
        EXPECT_NEAR(world.joint_states()[0].position[3], start / 2.0, 1e-9);
        EXPECT_EQ(world.joint_states()[0].speed[3], 0.0);
    }
}

/// A ring of boxes in space on ball joints, in motion: the joint that closes it is cut.
SceneDescription ring_scene(int links) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity.setZero();
    scene.simulation.sleep = false;
    const double radius = 0.5 / std::sin(pi / links);
    for (int i = 0; i < links; ++i) {
        const double angle = 2.0 * pi * (i + 0.5) / links, apothem = radius * std::cos(pi / links);
        BodyDescription& box =
            add_box(scene, {0.2, 1.0, 0.1}, {apothem * std::cos(angle), apothem * std::sin(angle), 0.0}, 1.0 + 0.2 * i);
        box.rotation = turn(Vec3::UnitZ(), angle);
        box.velocity = Vec3(0.3 * std::sin(i + 1.0), 0.2 * std::cos(2.0 * i), 0.4 * std::sin(3.0 * i));
        box.angular_velocity = Vec3(0.5, -0.3 * i, 1.0);
    }
    for (int i = 0; i < links; ++i) {
        const double angle = 2.0 * pi * i / links;
        add_joint(scene, JointType::ball, std::size_t((i + links - 1) % links), std::size_t(i),
                  {radius * std::cos(angle), radius * std::sin(angle), 0.0});
    }
    return scene;
}

TEST(Closures, AFreeRingKeepsItsMomenta) {
    for (const IntegratorKind integrator :
         {IntegratorKind::symplectic_euler, IntegratorKind::runge_kutta_4, IntegratorKind::exact}) {
        TreeScene t(ring_scene(6));
        ASSERT_EQ(t.step(1e-3, integrator), TreeFlight::Outcome::flown);  // fits the speeds
        const Vec3 momentum = t.momentum(), angular = t.angular_momentum(), center = t.center();
        const double energy = t.energy();
        for (int step = 0; step < 480; ++step) ASSERT_EQ(t.step(1.0 / 240.0, integrator), TreeFlight::Outcome::flown);
        EXPECT_LT((t.momentum() - momentum).norm(), 1e-13);
        EXPECT_LT((t.angular_momentum() - angular).norm(), 2e-13);
        EXPECT_LT((t.center() - center - 2.0 * momentum / 9.0).norm(), 1e-12);
        EXPECT_NEAR(t.energy(), energy, integrator == IntegratorKind::exact ? 1e-9 : 1e-3 * energy);
    }
}

// A ball on a rod to the world and another on that one: a double pendulum of points, in a plane.
TEST(Closures, RodsSwingToSecondOrder) {
    SceneDescription scene;
    scene.simulation.sleep = false;
    add_sphere(scene, 0.1, {1.0, 0.0, 0.0}, 1.0);
    add_sphere(scene, 0.1, {2.0, 0.0, 0.0}, 1.0);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto first = i == 0 ? std::nullopt : std::optional<std::size_t>(0);
        JointDescription& rod = add_joint(scene, JointType::distance, first, i, Vec3(double(i), 0.0, 0.0));
        rod.anchor_second.setZero();
        rod.length = 1.0;
    }
    const auto end = [&](int steps, IntegratorKind integrator) {
        SceneDescription run = scene;
        run.simulation.integrator = integrator;
        run.output.fps = 1.0;
        run.simulation.steps_per_frame = steps;
        World world(run);
        world.advance_frame();
        EXPECT_LT(largest_gap(world), 1e-13);
        return world.snapshot().bodies[1].origin;
    };
    const Vec3 expected = end(240, IntegratorKind::exact);
    EXPECT_LT((end(480, IntegratorKind::exact) - expected).norm(), 1e-10);
    const double coarse = (end(240, IntegratorKind::symplectic_euler) - expected).norm();
    const double fine = (end(480, IntegratorKind::symplectic_euler) - expected).norm();
    EXPECT_LT(fine, 1e-3);
    EXPECT_NEAR(coarse / fine, 4.0, 0.2);
}

// The forces of all joints give each body its acceleration: in a loop that turns evenly, and of a cut joint too.
TEST(Closures, LoadsOfALoop) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription scene = parallelogram(3.0);
        scene.simulation.integrator = integrator;
        World world(scene);
        for (int step = 0; step < 20; ++step) {
            const Snapshot before = world.snapshot();
            world.step();
            const Snapshot after = world.snapshot();
            const auto joints = world.joint_states();
            const auto gained = [&](std::size_t i) -> Vec3 {
                return (after.bodies[i].velocity - before.bodies[i].velocity) / scene.step();
            };
            EXPECT_LT((joints[0].force - joints[2].force - gained(0)).norm(), 1e-10);
            EXPECT_LT((joints[1].force - joints[3].force - gained(1)).norm(), 1e-10);
            EXPECT_LT((joints[2].force + joints[3].force - gained(2)).norm(), 1e-10);
        }
    }
}

// A motor turns one crank faster and faster, before the flat position. Joints of the tree and the one that is cut.
TEST(Closures, AJointOfALoopBreaks) {
    for (const std::size_t weak : {std::size_t(0), std::size_t(1), std::size_t(2), std::size_t(3)})
        for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
            SceneDescription scene = parallelogram(1.0);
            scene.simulation.integrator = integrator;
            JointMotor motor;
            motor.speed = 1e6;
            motor.max_force = 5.0;
            scene.joints[1 - weak % 2].turn[0].motor = motor;
            scene.joints[weak].break_force = 3.0;
            World world(scene);
            for (int step = 0; step < 80; ++step) {
                world.step();
                for (const JointState& joint : world.joint_states()) {
                    if (!joint.active) continue;
                    ASSERT_LT(joint.gap, 1e-9) << weak << " in step " << step;
                }
            }
            EXPECT_TRUE(world.joint_states()[weak].broken_at.has_value()) << weak;
        }
}

// A limit in a loop gives back e^2 of the energy.
TEST(Closures, ALoopReboundsFromALimit) {
    SceneDescription scene = parallelogram(2.0);
    JointAxis& axis = scene.joints[1].turn[0];
    axis.motion = JointAxis::Motion::limited;
    axis.lower = -0.5;
    axis.upper = 0.5;
    axis.restitution = 0.8;
    scene.simulation.integrator = IntegratorKind::exact;
    World world(scene);
    run(world, scene, 0.4);
    EXPECT_NEAR(world.joint_states()[1].speed[3], -1.6, 1e-9);
    EXPECT_NEAR(world.joint_states()[0].speed[3], -1.6, 1e-9);
    EXPECT_NEAR(world.joint_states()[0].position[3], 0.5 - 1.6 * 0.15, 1e-9);
}

}  // namespace
}  // namespace tumble::closures_test
