// The higher-order integrators in the world's steps: they move bodies without contact, and leave bodies in contact to
// symplectic Euler.
#include "support/rotation_reference.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::integrators_test {
using namespace tumble::testing;

namespace {

constexpr IntegratorKind better[] = {IntegratorKind::splitting, IntegratorKind::runge_kutta_4};

}  // namespace

// Both are exact for constant forces: the parabola to rounding, at any length of the steps.
TEST(BetterIntegrators, FallOnTheParabola) {
    for (const auto integrator : better) {
        SceneDescription scene;
        scene.simulation.steps_per_frame = 1;
        scene.output.fps = 10.0;
        scene.simulation.integrator = integrator;
        BodyDescription& body = add_box(scene, {1.0, 0.5, 0.3}, {1.0, 50.0, -3.0});
        body.velocity = Vec3(2.0, 3.0, -1.0);
        World world(scene);
        for (int n = 1; n <= 30; ++n) {
            world.advance_frame();
            const double t = n / 10.0;
            const BodyState b = world.snapshot().bodies[0];
            EXPECT_LT(
                (b.center_of_mass - body.position - t * body.velocity - Vec3(0.0, -0.5 * 9.81 * t * t, 0.0)).norm(),
                1e-13 * 50);
            EXPECT_LT((b.velocity - body.velocity - Vec3(0.0, -9.81 * t, 0.0)).norm(), 1e-13 * 50);
        }
    }
}

TEST(BetterIntegrators, RotateAFreeBodyAtTheirOrder) {
    for (const auto integrator : better) {
        double error[2];
        for (int k = 0; k < 2; ++k) {
            SceneDescription scene = empty_scene(4 << k);
            scene.simulation.integrator = integrator;
            BodyDescription& body = add_box(scene, {1.0, 0.6, 0.2}, Vec3::Zero());
            body.angular_velocity = Vec3(1.0, 3.0, 2.0);
            World world(scene);
            const Vec3 momentum = world.measure().angular_momentum;
            RotationReference<long double> truth(Vec3(0.4, 1.04, 1.36) / 12.0, Quat::Identity(), momentum);
            truth.advance(2.0);
            run(world, scene, 2.0);
            error[k] = truth.angle_to(world.snapshot().bodies[0].orientation);
            EXPECT_EQ(world.measure().angular_momentum, momentum);
        }
        const double order = integrator == IntegratorKind::splitting ? 2.0 : 4.0;
        EXPECT_NEAR(std::log2(error[0] / error[1]), order, 0.1) << error[0];
        EXPECT_LT(error[1], integrator == IntegratorKind::splitting ? 1e-3 : 1e-6);
    }
}

// A body can have its own integrator: two side by side.
TEST(BetterIntegrators, ABodyWithItsOwnIntegrator) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = 1;
    add_sphere(scene, 0.5, {0.0, 20.0, 0.0});
    add_sphere(scene, 0.5, {5.0, 20.0, 0.0}).integrator = IntegratorKind::splitting;
    World world(scene);
    run(world, scene, 1.0);
    EXPECT_NEAR(world.snapshot().bodies[0].center_of_mass.y(), 20.0 - 0.5 * 9.81 * (1.0 + 1.0 / 60.0), 1e-12);
    EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.y(), 20.0 - 0.5 * 9.81, 1e-12);
}

// In contact every integrator but the explicit one is symplectic Euler, to the last bit.
TEST(BetterIntegrators, RestAndSlideAsSymplecticEulerDoes) {
    for (const auto integrator : better) {
        Snapshot last[2];
        for (int k = 0; k < 2; ++k) {
            SceneDescription scene = ground_scene(0.0, 0.5);
            scene.simulation.integrator = k == 0 ? IntegratorKind::symplectic_euler : integrator;
            BodyDescription& box = add_box(scene, {1.0, 0.4, 0.8}, {0.0, 0.2, 0.0});
            box.friction = 0.5;
            box.velocity = Vec3(2.0, 0.0, 0.5);
            World world(scene);
            run(world, scene, 1.0);
            last[k] = world.snapshot();
        }
        EXPECT_EQ(last[0].bodies[1].center_of_mass, last[1].bodies[1].center_of_mass);
        EXPECT_EQ(last[0].bodies[1].orientation.coeffs(), last[1].bodies[1].orientation.coeffs());
        EXPECT_EQ(last[0].bodies[1].velocity, last[1].bodies[1].velocity);
    }
}

// Their falls keep the energy, and the first step after the impact retraces the last one of the fall: no correction is
// applied, unlike symplectic Euler, whose falls lose g h v / 2 that the bounce's step returns twice.
TEST(BetterIntegrators, AnElasticBallRetracesItsFall) {
    for (const auto integrator : {IntegratorKind::splitting, IntegratorKind::runge_kutta_4, IntegratorKind::exact}) {
        SceneDescription scene = ground_scene(1.0, 0.0, 1);
        scene.simulation.integrator = integrator;
        add_sphere(scene, 0.1, {0.0, 2.0, 0.0}).restitution = 1.0;
        World world(scene);
        const double energy = 9.81 * 2.0;
        for (int frame = 0; frame < 1200; ++frame) {
            world.advance_frame();
            const Measurement m = world.measure();
            ASSERT_NEAR(m.kinetic + m.potential, energy, 1e-10 * energy) << int(integrator) << ", frame " << frame;
        }
    }
}

// It bounces, lands, comes to rest and falls asleep on the ground, above it up to the allowed overlap of a contact.
TEST(BetterIntegrators, BounceAndComeToRest) {
    for (const auto integrator : better) {
        SceneDescription scene = ground_scene(0.5, 0.6);
        scene.simulation.integrator = integrator;
        BodyDescription& box = add_box(scene, {0.5, 0.3, 0.4}, {0.0, 2.0, 0.0});
        box.restitution = 0.5;
        box.friction = 0.6;
        box.rotation = turn({1.0, 0.4, 0.2}, 0.5);
        box.angular_velocity = Vec3(1.0, 2.0, -1.0);
        World world(scene);
        const double energy = world.measure().kinetic + world.measure().potential;
        run(world, scene, 6.0);
        const Measurement m = world.measure();
        EXPECT_LT(m.kinetic + m.potential, energy);
        EXPECT_LT(m.kinetic, 1e-6);
        EXPECT_LT(m.max_penetration, 1e-3);
        EXPECT_GE(m.contacts, 3);
    }
}

}  // namespace tumble::integrators_test
