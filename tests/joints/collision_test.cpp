// Joined bodies that collide, in both modes: a pendulum and a wall, cradles, chains.
#include "joint_scenes.h"

#include <gtest/gtest.h>

namespace tumble::collision_test {
namespace {

using namespace testing;

double energy_of(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

// The pendulum of joint_scenes.h: m g l / 2 / I about the hinge.
constexpr double inertia = 1.01 / 12.0 + 0.25, rate_squared = 9.81 * 0.5 / inertia;

/// Time from rest at 90 degrees to the angle `to` on the other side, s: the elliptic integral, by Simpson's rule.
double time_to(double to) {
    const double k = std::sin(0.25 * std::numbers::pi), from = std::asin(std::sin(0.5 * to) / k);
    const int n = 2000;
    const double h = (0.5 * std::numbers::pi - from) / n;
    double sum = 0.0;
    for (int i = 0; i <= n; ++i) {
        const double sine = k * std::sin(from + i * h);
        sum += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) / std::sqrt(1.0 - sine * sine);
    }
    return sum * h / 3.0 / std::sqrt(rate_squared);
}

struct WallBlow {
    double time, speed_before, speed_after;  // s; rad/s
    double later, energy;                    // J: long after the blow
};

/// A pendulum from 90 degrees against a wall at x = -0.3 m.
WallBlow blow_of_pendulum(double restitution, ImpactMode mode, int steps_per_frame) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi, steps_per_frame);
    scene.simulation.impacts = mode;
    scene.bodies[0].restitution = restitution;
    BodyDescription& wall = add_body(scene, PlaneShape{Vec3::UnitX(), -0.3}, Vec3::Zero());
    wall.type = BodyType::fixed;
    wall.restitution = 0.0;
    World world(scene);
    world.record_contacts();
    WallBlow blow{0.0, 0.0, 0.0, 0.0, 0.0};
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        if (world.contact_records().impacts.empty() || blow.time > 0.0) continue;
        blow.time = world.contact_records().impacts[0].when.time;
        const auto& struck = world.contact_records().struck;
        for (const StruckBody& body : struck)
            if (body.angular_velocity_before.norm() > 0.0) {
                blow.speed_before = body.angular_velocity_before.z();
                blow.speed_after = body.angular_velocity_after.z();
            }
        blow.energy = energy_of(world);
    }
    blow.later = energy_of(world);
    return blow;
}

TEST(JointCollision, APendulumHitsAWallAtItsTime) {
    const double angle = std::asin(-0.3 / std::sqrt(1.0025)) + std::atan(0.05);
    const double speed = -std::sqrt(2.0 * rate_squared * std::cos(angle));
    for (const double e : {1.0, 0.5}) {
        for (const int steps : {1, 4, 16}) {
            const WallBlow blow = blow_of_pendulum(e, ImpactMode::exact, steps);
            std::printf("e %g steps %d: time %.3e speed %.3e after %.3e energy %.3e\n", e, steps, blow.time - time_to(angle), blow.speed_before - speed, blow.speed_after + e * speed, blow.later - blow.energy);
            EXPECT_NEAR(blow.time, time_to(angle), 1e-10);
            EXPECT_NEAR(blow.speed_before, speed, 1e-9);
            EXPECT_NEAR(blow.speed_after, -e * speed, 1e-9);
        }
        const WallBlow stepped = blow_of_pendulum(e, ImpactMode::stepped, 16);
        std::printf("stepped: time %.3e speed %.3e after %.3e energy %.3e\n", stepped.time - time_to(angle), stepped.speed_before - speed, stepped.speed_after + e * speed, stepped.later - stepped.energy);
    }
}

/// Balls of radius 0.25 m side by side on pairs of rods of 2.5 m; the first is `angle` aside.
SceneDescription cradle_scene(int balls, double angle, double restitution) {
    SceneDescription scene;
    scene.simulation.sleep = false;
    for (int i = 0; i < balls; ++i) {
        const double x = 0.5 * i;
        const Vec3 place = i == 0 ? Vec3(x - 2.5 * std::sin(angle), 2.5 - 2.5 * std::cos(angle), 0.0) : Vec3(x, 0, 0);
        add_sphere(scene, 0.25, place).restitution = restitution;
        for (const double z : {-0.45, 0.45}) {
            JointDescription& rod =
                add_joint(scene, JointType::distance, std::nullopt, std::size_t(i), Vec3(x, 2.5, z));
            rod.anchor_second = Vec3::Zero();
            rod.length = std::hypot(2.5, 0.45);
        }
    }
    return scene;
}

TEST(JointCollision, AHangingCradlePassesTheImpulseOn) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = cradle_scene(5, 0.8, 1.0);
        scene.simulation.impacts = mode;
        World world(scene);
        const double start = energy_of(world);
        double highest = 0.0, others = 0.0;
        for (int frame = 0; frame < 96; ++frame) {  // the last ball returns after 100
            world.advance_frame();
            const Snapshot snapshot = world.snapshot();
            highest = std::max(highest, snapshot.bodies[4].center_of_mass.y());
            if (frame > 55)
                for (std::size_t i = 0; i < 4; ++i) others = std::max(others, snapshot.bodies[i].velocity.norm());
        }
        std::printf("highest %.3e others %.3e energy %.3e gap %.3e\n", highest - 2.5 * (1.0 - std::cos(0.8)), others, energy_of(world) - start, largest_gap(world));
        EXPECT_NEAR(highest, 2.5 * (1.0 - std::cos(0.8)), mode == ImpactMode::exact ? 1e-3 : 2e-2);
        EXPECT_LT(others, mode == ImpactMode::exact ? 1e-9 : 0.02);
    }
}

}  // namespace
}  // namespace tumble::collision_test
