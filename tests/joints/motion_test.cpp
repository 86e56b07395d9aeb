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
    std::printf("240/s: %.3e gap %.1e energy %.1e; 960/s: %.3e gap %.1e energy %.1e\n", coarse.error, coarse.gap,
                coarse.energy, fine.error, fine.gap, fine.energy);
    EXPECT_LT(fine.error, 7e-3);
    EXPECT_LT(fine.error, 0.3 * coarse.error);
    EXPECT_LT(coarse.gap, 1e-12);
    EXPECT_LT(fine.gap, 1e-12);
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
    std::printf("P %.1e L %.1e gap %.1e E %.3f dE %.1e\n", (end.first - start.first).norm(),
                (end.second - start.second).norm(), gap, energy, change);
    EXPECT_LT((end.first - start.first).norm(), 1e-13);
    EXPECT_LT((end.second - start.second).norm(), 1e-12);
    EXPECT_LT(gap, 1e-12);
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
    std::printf("quarter %.9f gap %.1e\n", crossed, gap);
    EXPECT_NEAR(4.0 * crossed, 1.9357500144084348, 4e-3);
    EXPECT_LT(gap, 1e-12);
}

}  // namespace
}  // namespace tumble::motion_test
