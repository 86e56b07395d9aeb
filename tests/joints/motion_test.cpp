// Motion of jointed bodies against closed forms and high-precision references.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::motion_test {
using namespace tumble::testing;

namespace {

double angle_of(const BodyState& body) {
    const Vec3 d = body.orientation * Vec3::UnitX();
    return std::atan2(d.x(), -d.y());
}

double energy_of(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

struct Motion {
    double error, gap, energy;
};

// Largest error of both angles at t = 2 s, and the largest gap and change of energy up to then.
Motion double_pendulum(int steps_per_frame) {
    const SceneDescription scene = double_pendulum_scene(steps_per_frame);
    World world(scene);
    double gap = 0.0, energy = 0.0;
    const double start = energy_of(world);
    for (int frame = 0; frame < 120; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        energy = std::max(energy, std::abs(energy_of(world) - start));
    }
    const Snapshot s = world.snapshot();
    const double first = std::abs(angle_of(s.bodies[0]) - -0.0845270358378211);
    const double second = std::abs(angle_of(s.bodies[1]) - 0.3920419302606883);
    return {std::max(first, second), gap, energy};
}

TEST(JointMotion, ADoublePendulumConvergesWithItsGapAtRounding) {
    const Motion coarse = double_pendulum(4), fine = double_pendulum(16);
    EXPECT_LT(fine.error, 1e-5);
    EXPECT_LT(fine.error, 0.08 * coarse.error);  // second order, with fewer passes
    EXPECT_LT(coarse.gap, 1e-12);
    EXPECT_LT(fine.gap, 1e-12);
}

// Links that turn by 0.2 rad/s here and there pull the chain taut: by the sum of their centripetal forces, 1e5 times
// the force on the link at its end. The solver of contacts, which takes the steps that no flight can, leaves gaps of
// 1e-7 m.
TEST(JointMotion, ALongChainFliesFromItsFirstStep) {
    SceneDescription scene = empty_scene();
    scene.output.fps = 240.0;
    scene.simulation.steps_per_frame = 1;
    scene.simulation.sleep = false;
    constexpr int links = 10000;
    Vec3 velocity = Vec3::Zero(), spin(0.0, -0.1, -0.1);
    for (int i = 0; i < links; ++i) {
        const Vec3 axis = i % 2 ? Vec3::UnitY() : Vec3::UnitZ();
        spin += (i / 2 % 2 ? -0.2 : 0.2) * axis;
        BodyDescription& rod = add_box(scene, {1.0, 0.1, 0.1}, {double(i), 0.0, 0.0});
        const Vec3 half = spin.cross(Vec3(0.5, 0.0, 0.0));
        rod.velocity = velocity + half;
        rod.angular_velocity = spin;
        velocity = rod.velocity + half;
        if (i > 0) add_joint(scene, JointType::hinge, std::size_t(i - 1), std::size_t(i), {i - 0.5, 0.0, 0.0}, axis);
    }
    World world(scene);
    const double energy = energy_of(world);
    for (int frame = 0; frame < 2; ++frame) {
        world.advance_frame();
        EXPECT_LT(largest_gap(world), 1e-10);
        EXPECT_NEAR(energy_of(world), energy, 0.01 * energy);
    }
}

TEST(JointMotion, AFreeChainKeepsItsMomenta) {
    const SceneDescription scene = free_chain_scene();
    World world(scene);
    world.step();
    const auto momenta = [&] {
        std::pair<Vec3, Vec3> sum{Vec3::Zero(), Vec3::Zero()};
        for (const BodyState& body : world.snapshot().bodies) {
            sum.first += body.momentum;
            sum.second += body.angular_momentum + body.center_of_mass.cross(body.momentum);
        }
        return sum;
    };
    const auto start = momenta();
    const double energy = energy_of(world);
    double gap = 0.0, change = 0.0;
    for (int frame = 0; frame < 300; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        change = std::max(change, std::abs(energy_of(world) - energy));
    }
    const auto end = momenta();
    EXPECT_LT((end.first - start.first).norm(), 1e-13);
    EXPECT_LT((end.second - start.second).norm(), 1e-12);
    EXPECT_LT(gap, 1e-12);
}

// The errors at t = 2 s of the flight of order 2, 4 and 8.
TEST(JointMotion, FlightsOfHigherOrder) {
    const auto run_with = [](IntegratorKind kind, int steps_per_frame) {
        SceneDescription scene = double_pendulum_scene(steps_per_frame);
        scene.simulation.integrator = kind;
        World world(scene);
        const double start = energy_of(world);
        double gap = 0.0, energy = 0.0;
        for (int frame = 0; frame < 120; ++frame) {
            world.advance_frame();
            gap = std::max(gap, largest_gap(world));
            energy = std::max(energy, std::abs(energy_of(world) - start));
        }
        const Snapshot s = world.snapshot();
        return Motion{std::max(std::abs(angle_of(s.bodies[0]) - -0.0845270358378211),
                               std::abs(angle_of(s.bodies[1]) - 0.3920419302606883)),
                      gap, energy};
    };
    EXPECT_LT(run_with(IntegratorKind::symplectic_euler, 16).error, 1e-5);
    EXPECT_LT(run_with(IntegratorKind::runge_kutta_4, 4).error, 2e-7);
    const Motion exact = run_with(IntegratorKind::exact, 4);
    EXPECT_LT(exact.error, 1e-12);
    EXPECT_LT(exact.energy, 1e-11);
    EXPECT_LT(exact.gap, 1e-14);
}

// A hinged rod through its lowest point: the period from 90 degrees by the elliptic integral, 1.9357500144084348 s.
TEST(JointMotion, APhysicalPendulum) {
    const SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    World world(scene);
    double gap = 0.0, last = 0.5 * std::numbers::pi, crossed = 0.0;
    for (int step = 1; crossed == 0.0; ++step) {
        world.step();
        gap = std::max(gap, largest_gap(world));
        const double angle = angle_of(world.snapshot().bodies[0]);
        if (last > 0.0 && angle <= 0.0) crossed = (step - 1 + last / (last - angle)) / 960.0;
        last = angle;
    }
    EXPECT_NEAR(4.0 * crossed, 1.9357500144084348, 4e-3);
    EXPECT_LT(gap, 1e-12);
}

// A pendulum with e = 1 against a wall returns to its height; a chain of ten boxes falls on the ground and rests.
TEST(JointMotion, APendulumBouncesOffAWall) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    scene.bodies[0].restitution = 1.0;
    BodyDescription& wall = add_box(scene, {0.2, 1.0, 1.0}, {-0.16, -1.4, 0.0});
    wall.type = BodyType::fixed;
    World world(scene);
    const double start = energy_of(world);
    double lowest = start, highest = start, angle = 10.0;
    for (int frame = 0; frame < 240; ++frame) {
        world.advance_frame();
        highest = std::max(highest, energy_of(world));
        lowest = std::min(lowest, energy_of(world));
        angle = std::min(angle, angle_of(world.snapshot().bodies[0]));
    }
    EXPECT_GT(angle, -0.2);
    EXPECT_NEAR(lowest, start, 0.05);
    EXPECT_NEAR(highest, start, 0.05);
    EXPECT_LT(largest_gap(world), 1e-11);
}

TEST(JointMotion, AChainFallsAndRests) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = ground_scene(0.3, 0.5);
        scene.simulation.impacts = mode;
        for (int i = 0; i < 10; ++i) {
            add_box(scene, {0.2, 0.1, 0.1}, {0.2 * i, 1.0 + 0.05 * i, 0.02 * (i % 2)}, 1.0 + i % 3).friction = 0.5;
            if (i > 0)
                // A link that hangs between two others by balls would swing on and on.
                add_joint(scene, mode == ImpactMode::exact ? JointType::hinge : JointType::ball, std::size_t(i),
                          std::size_t(i + 1), {0.2 * i - 0.1, 1.0 + 0.05 * i - 0.025, 0.01}, Vec3::UnitZ());
        }
        World world(scene);
        double gap = 0.0, last = energy_of(world), gain = 0.0;
        for (int frame = 0; frame < 480; ++frame) {
            world.advance_frame();
            gap = std::max(gap, largest_gap(world));
            gain = std::max(gain, energy_of(world) - last);
            last = energy_of(world);
        }
        const Snapshot snapshot = world.snapshot();
        const auto awake = std::count_if(snapshot.bodies.begin() + 1, snapshot.bodies.end(),
                                         [](const BodyState& body) { return !body.asleep; });
        EXPECT_LT(gap, 1e-6);
        EXPECT_LT(gain, 0.01);
        EXPECT_EQ(awake, 0);
    }
}

}  // namespace
}  // namespace tumble::motion_test
