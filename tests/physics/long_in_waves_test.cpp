// Bodies that are long beside the waves, and float by the pressure of the waves on their panels.
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tumble::long_in_waves_test {
using namespace tumble::testing;

namespace {

constexpr double pi = std::numbers::pi, g = 9.81;

SceneDescription sea(IntegratorKind integrator, double frame, int steps_per_frame) {
    SceneDescription scene = empty_scene(steps_per_frame);
    scene.simulation.gravity = {0.0, -g, 0.0};
    scene.simulation.integrator = integrator;
    scene.simulation.sleep = false;
    scene.output.fps = 1.0 / frame;
    scene.water = WaterDescription{};
    return scene;
}

BodyState state(const World& world, std::size_t body = 0) { return world.snapshot().bodies[body]; }

TEST(LongInWaves, ASparHeavesByThePressureAtItsFoot) {  // W10, of a spar longer than a tenth of the wave
    const double omega = 2.0 * pi / 3.0, amplitude = 1e-3, draft = 0.5, length = 1.5;
    SceneDescription scene = sea(IntegratorKind::runge_kutta_4, 3.0, 600);
    scene.water->drag = 0.0;
    scene.water->added_mass = false;
    scene.water->waves.push_back({2.0 * amplitude, 2.0 * pi * g / (omega * omega), {1.0, 0.0, 0.0}, 0.0});
    const double heave = 1.0299183063485421 * amplitude, rest = 0.5 * length - draft;
    BodyDescription& spar = float_body(scene, BoxShape{{0.02, length, 0.02}}, 1000.0 * draft / length, rest + heave);
    spar.center_of_mass = Vec3(0.0, -0.7, 0.0);
    World world(scene);
    for (int n = 0; n < 3; ++n) {
        world.advance_frame();
        // It drifts, tilts and then heaves a little otherwise.
        EXPECT_NEAR(state(world).origin.y() - rest, heave, (n == 0 ? 2e-4 : 2e-3) * heave) << n;
    }
}

/// Half of the way between the highest and the lowest place in the last half of 20 s.
double heave_of(double length) {
    SceneDescription scene = sea(IntegratorKind::symplectic_euler, 1.0 / 60.0, 4);
    scene.water->waves.push_back({0.3, 4.0, {1.0, 0.0, 0.0}, 0.0});
    float_body(scene, BoxShape{{length, 0.3, 1.5}}, 500.0, 0.0);
    World world(scene);
    double highest = -1.0, lowest = 1.0;
    for (int n = 0; n < 1200; ++n) {
        world.advance_frame();
        if (n < 600) continue;
        highest = std::max(highest, state(world).center_of_mass.y());
        lowest = std::min(lowest, state(world).center_of_mass.y());
    }
    return 0.5 * (highest - lowest);
}

TEST(LongInWaves, ARaftAcrossSeveralWavesHardlyHeaves) {
    const double small = heave_of(0.39), whole = heave_of(4.0), several = heave_of(12.0);
    EXPECT_NEAR(small, 0.15, 0.03);  // follows the surface
    EXPECT_LT(whole, 0.2 * small);
    EXPECT_LT(several, 0.1 * small);
}

TEST(LongInWaves, BodiesOfAllShapesStayBounded) {
    const auto scene_of = [](IntegratorKind integrator, int steps) {
        SceneDescription scene = sea(integrator, 1.0 / 60.0, steps);
        scene.water->waves.push_back({0.3, 3.0, {0.8, 0.0, 0.6}, 40.0});
        float_body(scene, BoxShape{{5.0, 0.2, 1.5}}, 400.0, 0.4);
        float_body(scene, BoxShape{{1.0, 0.8, 0.8}}, 600.0, 0.8).position.z() = 5.0;
        float_body(scene, SphereShape{0.5}, 300.0, 0.8).position.z() = 10.0;
        float_body(scene, SphereShape{0.5}, 10.0, 0.8).position.z() = 15.0;
        float_body(scene, BoxShape{{2.0, 0.01, 2.0}}, 500.0, 0.4).position.z() = 20.0;
        return scene;
    };
    const auto check = [](const SceneDescription& scene, int frames) {
        World world(scene);
        for (int n = 0; n < frames; ++n) {
            world.advance_frame();
            for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
                const BodyState body = state(world, i);
                ASSERT_LT(std::abs(body.center_of_mass.y()), 2.0) << i << ' ' << n;
                ASSERT_LT(body.velocity.norm(), 6.0) << i << ' ' << n;
                ASSERT_LT(body.angular_velocity.norm(), 20.0) << i << ' ' << n;
            }
        }
    };
    for (const int steps : {4, 16}) check(scene_of(IntegratorKind::symplectic_euler, steps), 3600);
    for (const IntegratorKind integrator :
         {IntegratorKind::splitting, IntegratorKind::runge_kutta_4, IntegratorKind::exact})
        check(scene_of(integrator, 4), 120);
}

TEST(LongInWaves, ExactImpactsAndStepsAgree) {
    SceneDescription scene = sea(IntegratorKind::exact, 0.1, 16);
    scene.water->waves.push_back({0.2, 2.0, {1.0, 0.0, 0.0}, 0.0});
    float_body(scene, SphereShape{0.3}, 600.0, 0.5);
    World stepped(scene);
    scene.simulation.impacts = ImpactMode::exact;
    World exact(scene);
    for (int n = 0; n < 20; ++n) {
        stepped.advance_frame();
        exact.advance_frame();
    }
    EXPECT_LT((state(stepped).center_of_mass - state(exact).center_of_mass).norm(), 1e-9);
}

TEST(LongInWaves, EveryNumberOfThreadsGivesTheSameBytes) {
    SceneDescription scene = sea(IntegratorKind::symplectic_euler, 1.0 / 60.0, 4);
    scene.water->waves.push_back({0.1, 1.0, {1.0, 0.0, 0.0}, 0.0});
    for (int n = 0; n < 40; ++n)
        float_body(scene, BoxShape{{0.5, 0.2, 0.25}}, 300.0 + 10.0 * n, 0.1 * n).position.x() = 0.05 * n;
    World one(scene, 1), eight(scene, 8);
    for (int n = 0; n < 60; ++n) {
        one.advance_frame();
        eight.advance_frame();
    }
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        EXPECT_EQ(state(one, i).center_of_mass, state(eight, i).center_of_mass);
        EXPECT_EQ(state(one, i).orientation.coeffs(), state(eight, i).orientation.coeffs());
    }
}

TEST(LongInWaves, ALongBodyAboveTheCrestsFallsAsleep) {
    SceneDescription scene = sea(IntegratorKind::symplectic_euler, 1.0 / 60.0, 4);
    scene.simulation.sleep = true;
    scene.water->level = -1.0;
    scene.water->waves.push_back({0.2, 2.0, {1.0, 0.0, 0.0}, 0.0});
    add_body(scene, BoxShape{{8.0, 0.5, 8.0}}, {0.0, -0.25, 0.0}).type = BodyType::fixed;
    float_body(scene, BoxShape{{4.0, 0.2, 1.0}}, 500.0, 0.1);
    World world(scene);
    for (int n = 0; n < 180; ++n) world.advance_frame();
    EXPECT_TRUE(state(world, 1).asleep);
}

}  // namespace
}  // namespace tumble::long_in_waves_test
