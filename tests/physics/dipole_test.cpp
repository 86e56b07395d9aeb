// Magnets as dipoles against closed forms: field, force, torque, momentum, energy.
#include "core/elliptic.h"
#include "joints/joint_scenes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble::dipole_test {
using namespace tumble::testing;

namespace {

constexpr double pi = std::numbers::pi, strength = 0.3;

SceneDescription space(IntegratorKind integrator) {
    SceneDescription scene = empty_scene();
    scene.simulation.integrator = integrator;
    scene.simulation.sleep = false;
    return scene;
}

PairForceDescription& add_dipoles(SceneDescription& scene, std::vector<Vec3> moments) {
    PairForceDescription& force = add_pair_force(scene, PairForceKind::dipole, strength, {});
    for (std::size_t body = 0; body < moments.size(); ++body) force.bodies.push_back(body);
    force.moments = std::move(moments);
    return force;
}

void run_frames(World& world, int frames) {
    for (int n = 0; n < frames; ++n) world.advance_frame();
}

BodyState state(const World& world, std::size_t index) { return world.snapshot().bodies[index]; }

double total(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

constexpr double mass = 2.0, radius = 0.1, inertia = 0.4 * mass * radius * radius;

/// A ball with a moment along its x axis and a fixed magnet at `place`, along x too.
SceneDescription ball_and_magnet(IntegratorKind integrator, const Vec3& place, const Quat& rotation) {
    SceneDescription scene = space(integrator);
    add_sphere(scene, radius, Vec3::Zero(), mass).rotation = rotation;
    add_sphere(scene, radius, place).type = BodyType::fixed;
    add_dipoles(scene, {{0.7, 0.0, 0.0}, {1.3, 0.0, 0.0}});
    return scene;
}

/// A compass needle half way between two fixed magnets: there the field, 4 k m / d^3 along x, has no gradient.
constexpr double needle_moment = 0.7, field = 4.0 * strength * 1.3 / 8.0, first_angle = 0.9;
SceneDescription compass(IntegratorKind integrator) {
    SceneDescription scene = space(integrator);
    add_sphere(scene, radius, Vec3::Zero(), mass).rotation = turn(Vec3::UnitZ(), first_angle);
    for (const double side : {-2.0, 2.0}) add_sphere(scene, radius, {side, 0.0, 0.0}).type = BodyType::fixed;
    add_dipoles(scene, {{needle_moment, 0.0, 0.0}, {1.3, 0.0, 0.0}, {1.3, 0.0, 0.0}});
    return scene;
}

// The period of a pendulum at any amplitude: 4 K(sin(angle / 2)) / omega.
double compass_period() {
    const double half = std::sin(0.5 * first_angle);
    return 4.0 * carlson_rf(0.0, 1.0 - half * half, 1.0) / std::sqrt(needle_moment * field / inertia);
}

/// Two magnets that pass and turn each other.
SceneDescription two_free_magnets(IntegratorKind integrator) {
    SceneDescription scene = space(integrator);
    BodyDescription& first = add_box(scene, {0.2, 0.1, 0.05}, {-1.0, 0.1, 0.0}, 1.0);
    first.velocity = {0.3, 0.4, -0.1};
    first.angular_velocity = {1.0, 2.0, -1.0};
    first.rotation = turn({1.0, 2.0, 3.0}, 0.8);
    BodyDescription& second = add_box(scene, {0.1, 0.1, 0.3}, {0.8, -0.3, 0.2}, 2.0);
    second.velocity = {-0.1, -0.4, 0.2};
    second.angular_velocity = {0.0, 0.5, 0.7};
    add_dipoles(scene, {{0.5, 0.2, 0.1}, {0.1, -0.4, 0.6}}).softening = 0.2;
    return scene;
}

}  // namespace

// B = 2 k m / d^3 ahead of the fixed magnet and -k m / d^3 beside it; torque m x B.
TEST(Dipoles, TorqueInTheFieldOfAFixedMagnet) {
    const double d = 0.8, angle = 0.4;
    for (const auto& [place, share] : {std::pair(Vec3(d, 0.0, 0.0), 2.0), {Vec3(0.0, d, 0.0), -1.0}})
        for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY())}) {
            SceneDescription scene = ball_and_magnet(IntegratorKind::symplectic_euler, place, turn(axis, angle));
            World world(scene);
            world.step();
            const double torque = -share * strength * 0.7 * 1.3 / (d * d * d) * std::sin(angle);
            const Vec3 expected = torque * scene.step() / inertia * axis;
            EXPECT_LT((state(world, 0).angular_velocity - expected).norm(), 1e-13 * expected.norm());
        }
}

// In line 6 k m1 m2 / d^4; with softening -dU/dd of U = k m1 m2 (1 / s^3 - 3 d^2 / s^5).
TEST(Dipoles, ForceAlongTheAxis) {
    for (const double softening : {0.0, 0.3}) {
        const double d = 0.8, s = std::sqrt(d * d + softening * softening);
        SceneDescription scene = ball_and_magnet(IntegratorKind::symplectic_euler, {d, 0.0, 0.0}, Quat::Identity());
        scene.pair_forces[0].softening = softening;
        World world(scene);
        const double pair = strength * 0.7 * 1.3;
        EXPECT_NEAR(world.measure().potential, pair * (1.0 / (s * s * s) - 3.0 * d * d / (s * s * s * s * s)), 1e-14);
        world.step();
        double force = pair * (15.0 * d * d * d / std::pow(s, 7) - 9.0 * d / std::pow(s, 5));
        if (softening == 0.0) force = 6.0 * pair / (d * d * d * d);
        const Vec3 expected(force * scene.step() / mass, 0.0, 0.0);
        EXPECT_LT((state(world, 0).velocity - expected).norm(), 1e-13 * expected.norm());
        EXPECT_LT(state(world, 0).angular_velocity.norm(), 1e-15);
    }
}

// Crosswise: F on the first = 3 k m1 m2 / d^4 across the line.
TEST(Dipoles, ForceAcrossTheAxis) {
    const double d = 0.8;
    SceneDescription scene =
        ball_and_magnet(IntegratorKind::symplectic_euler, {d, 0.0, 0.0}, turn(Vec3::UnitZ(), 0.5 * pi));
    World world(scene);
    world.step();
    const Vec3 expected(0.0, -3.0 * strength * 0.7 * 1.3 / (d * d * d * d) * scene.step() / mass, 0.0);
    EXPECT_LT((state(world, 0).velocity - expected).norm(), 1e-13 * expected.norm());
}

TEST(Dipoles, ACompassNeedleSwingsLikeAPendulum) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = compass(IntegratorKind::exact);
        scene.simulation.impacts = mode;
        scene.output.fps = 64.0 / compass_period();
        World world(scene);
        const double energy = total(world);
        run_frames(world, 3 * 64);
        EXPECT_LT(state(world, 0).angular_velocity.norm(), 1e-9);
        EXPECT_LT(
            (state(world, 0).orientation * Vec3::UnitX() - Vec3(std::cos(first_angle), std::sin(first_angle), 0.0))
                .norm(),
            1e-10);
        EXPECT_LT(state(world, 0).center_of_mass.norm(), 1e-10);
        EXPECT_NEAR(total(world), energy, 1e-13);
    }
}

// Errors of the needle's speed after a quarter of the period fall 2, 4 and 16 times with half the step.
TEST(Dipoles, IntegratorsKeepTheirOrder) {
    const double half = std::sin(0.5 * first_angle), top = 2.0 * half * std::sqrt(needle_moment * field / inertia);
    const auto error = [&](IntegratorKind integrator, int steps) {
        SceneDescription scene = compass(integrator);
        scene.output.fps = 4.0 / compass_period();
        scene.simulation.steps_per_frame = steps;
        World world(scene);
        run_frames(world, 1);
        const Vec3 along = state(world, 0).orientation * Vec3::UnitX();
        return std::abs(state(world, 0).angular_velocity.norm() - top) + std::abs(along.y());
    };
    for (const auto& [integrator, order] : {std::pair(IntegratorKind::explicit_euler, 1.0),
                                            {IntegratorKind::symplectic_euler, 1.0},
                                            {IntegratorKind::splitting, 2.0},
                                            {IntegratorKind::runge_kutta_4, 4.0}})
        EXPECT_NEAR(std::log2(error(integrator, 32) / error(integrator, 64)), order, 0.3) << int(integrator);
}

TEST(Dipoles, TwoFreeMagnetsKeepMomentumAndEnergy) {
    for (const auto& [integrator, mode, bound] : {std::tuple(IntegratorKind::exact, ImpactMode::exact, 1e-12),
                                                  {IntegratorKind::exact, ImpactMode::stepped, 1e-12},
                                                  {IntegratorKind::runge_kutta_4, ImpactMode::stepped, 1e-8},
                                                  {IntegratorKind::splitting, ImpactMode::stepped, 1e-4}}) {
        SceneDescription scene = two_free_magnets(integrator);
        scene.simulation.impacts = mode;
        World world(scene);
        world.record_energy();
        const Measurement before = world.measure();
        const Vec3 spin = state(world, 0).angular_velocity;
        run_frames(world, 240);
        const Measurement after = world.measure();
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-13);
        // The kicks of splitting keep it to rounding; the stages of the others to their order.
        const double turned = integrator == IntegratorKind::splitting ? 1e-13 : bound;
        EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), turned) << int(integrator);
        EXPECT_NEAR(after.kinetic + after.potential, before.kinetic + before.potential, bound) << int(integrator);
        EXPECT_NEAR(world.contact_records().energy.work, 0.0, std::max(1e-10, bound));
        EXPECT_GT((state(world, 0).angular_velocity - spin).norm(), 0.1);
    }
}

// A magnet on a track that turns: the moment of a heavy ball takes the integral of the torque over the turn.
TEST(Dipoles, AKinematicMagnetTurnsWithinTheStep) {
    const double d = 0.8, speed = 2.0;
    SceneDescription scene = space(IntegratorKind::runge_kutta_4);
    add_sphere(scene, radius, Vec3::Zero(), 1e9 * mass);
    BodyDescription& magnet = add_sphere(scene, radius, {d, 0.0, 0.0});
    magnet.type = BodyType::kinematic;
    magnet.interpolation = Interpolation::linear;
    for (int i = 0; i < 8; ++i)
        magnet.keyframes.push_back({0.5 * i, magnet.position, turn(Vec3::UnitZ(), 0.5 * speed * i)});
    add_dipoles(scene, {{0.7, 0.0, 0.0}, {1.3, 0.0, 0.0}});
    World world(scene);
    run_frames(world, 60);
    const double most = strength * 0.7 * 1.3 / (d * d * d);
    const double expected = most * (std::cos(speed) - 1.0) / speed;
    EXPECT_NEAR(1e9 * inertia * state(world, 0).angular_velocity.z(), expected, 1e-8 * std::abs(expected));
}

// Forces of a step on jointed bodies have torques too.
TEST(Dipoles, ANeedleOnAHingeSwings) {
    SceneDescription scene = compass(IntegratorKind::symplectic_euler);
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    scene.output.fps = 64.0 / compass_period();
    World world(scene);
    run_frames(world, 32);
    const Vec3 along = state(world, 0).orientation * Vec3::UnitX();
    EXPECT_NEAR(std::atan2(along.y(), along.x()), -first_angle, 2e-2);
}

// Within its span of time alone.
TEST(Dipoles, SpansBoundTheTorque) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription scene = ball_and_magnet(integrator, {0.8, 0.0, 0.0}, turn(Vec3::UnitZ(), 0.3));
        scene.bodies[0].mass = 1e9;
        scene.pair_forces[0].start = 0.1003;
        scene.pair_forces[0].end = 0.2509;
        World world(scene);
        run_frames(world, 30);
        const double torque = -2.0 * strength * 0.7 * 1.3 / (0.8 * 0.8 * 0.8) * std::sin(0.3);
        EXPECT_NEAR(0.4e9 * radius * radius * state(world, 0).angular_velocity.z(), 0.1506 * torque,
                    1e-9 * std::abs(torque));
    }
}

}  // namespace tumble::dipole_test
