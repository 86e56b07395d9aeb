// Coulomb friction against the textbook: sliding, sticking, rolling.
#include "core/deterministic_math.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::friction_test {
using namespace tumble::testing;

namespace {
constexpr double g = 9.81;
}

// v^2 / (2 mu g), in any direction across the ground: a cone, not a pyramid.
TEST(Friction, BoxSlidesToRest) {
    for (const double direction : {0.0, 0.5, pi / 4}) {
        SceneDescription scene = ground_scene(0.0, 0.4, 32);
        BodyDescription& box = add_box(scene, {1.0, 0.2, 1.0}, {0.0, 0.1, 0.0});
        box.friction = 0.4;
        box.velocity = 3.0 * Vec3(std::cos(direction), 0.0, std::sin(direction));
        World world(scene);
        run(world, scene, 2.0);
        const BodyState b = world.snapshot().bodies[1];
        const double way = Vec3(b.center_of_mass.x(), 0.0, b.center_of_mass.z()).norm();
        EXPECT_NEAR(way, 9.0 / (2.0 * 0.4 * g), 2e-3) << direction;
        EXPECT_LT(b.velocity.norm(), 1e-9);
        EXPECT_NEAR(b.center_of_mass.z(), way * std::sin(direction), 1e-3);
    }
}

// On an incline mu above tan(theta) sticks, below it slides with g (sin - mu cos).
TEST(Friction, InclineDecidesStickOrSlip) {
    const double angle = 30.0 * pi / 180.0;
    for (const double mu : {0.99 * std::tan(angle), 1.01 * std::tan(angle)}) {
        SceneDescription scene = ground_scene(0.0, mu, 16);
        scene.bodies[0].shape = PlaneShape{Vec3(-std::sin(angle), std::cos(angle), 0.0), 0.0};
        BodyDescription& box = add_box(scene, {1.0, 0.2, 1.0}, 0.1 * Vec3(-std::sin(angle), std::cos(angle), 0.0));
        box.friction = mu;
        box.rotation = turn(Vec3::UnitZ(), angle);
        scene.simulation.sleep = false;
        World world(scene);
        run(world, scene, 4.0);
        const double way = (world.snapshot().bodies[1].center_of_mass - box.position).norm();
        const double a = g * (std::sin(angle) - mu * std::cos(angle));
        if (a > 0.0)
            EXPECT_NEAR(way, 0.5 * a * 16.0, 0.01 * 0.5 * a * 16.0 + 1e-3);
        else
            EXPECT_LT(way, 1e-4);
    }
}

// A sliding sphere rolls without slipping at 5/7 of its speed, after 2 v / (7 mu g).
TEST(Friction, SphereGoesFromSlidingToRolling) {
    SceneDescription scene = ground_scene(0.0, 0.3, 32);
    BodyDescription& ball = add_sphere(scene, 0.5, {0.0, 0.5, 0.0});
    ball.friction = 0.3;
    ball.velocity = Vec3(7.0, 0.0, 0.0);
    World world(scene);
    run(world, scene, 0.5 * 2.0 * 7.0 / (7.0 * 0.3 * g));
    EXPECT_GT(world.snapshot().bodies[1].velocity.x(), 5.5);
    run(world, scene, 1.0);
    const BodyState b = world.snapshot().bodies[1];
    EXPECT_NEAR(b.velocity.x(), 5.0, 1e-3);
    EXPECT_NEAR(b.angular_velocity.z(), -10.0, 2e-3);
}

// Without friction nothing rotates and nothing slows.
TEST(Friction, NoneMeansNone) {
    SceneDescription scene = ground_scene(0.0, 0.0);
    BodyDescription& box = add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0});
    box.velocity = Vec3(2.0, 0.0, 1.0);
    World world(scene);
    run(world, scene, 3.0);
    const BodyState b = world.snapshot().bodies[1];
    EXPECT_NEAR(b.velocity.x(), 2.0, 1e-12);
    EXPECT_NEAR(b.velocity.z(), 1.0, 1e-12);
    EXPECT_LT(b.angular_velocity.norm(), 1e-12);
}

// The friction of a bounce is bounded by the impact's impulse: a dropped spinning ball gains mu (1 + e) v at most.
TEST(Friction, BounceOfASpinningBall) {
    SceneDescription scene = ground_scene(0.5, 0.2, 64);
    BodyDescription& ball = add_sphere(scene, 0.5, {0.0, 1.5, 0.0});
    ball.friction = 0.2;
    ball.angular_velocity = Vec3(0.0, 0.0, -50.0);
    World world(scene);
    run(world, scene, 0.7);
    const double landing = std::sqrt(2.0 * g * 1.0);
    EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 0.2 * 1.5 * landing, 0.02 * landing);
}

// A body that slides and spins has less friction against either, and ends both at about the same time: each element of
// a plate's face, under uniform pressure, has friction against its own slip. With enough friction for both, a spin
// would not change the slide.
TEST(Friction, SlidingAndSpinningShareIt) {
    const double mu = 0.2, side = 0.4, inertia = side * side / 6.0, dt = 1e-3;  // of the unit mass
    struct Case {
        double speed, spin;  // m/s, rad/s
    };
    for (const Case& start : {Case{3.0, 20.0}, Case{3.0, 5.0}, Case{1.0, 30.0}, Case{1.0, 10.0}}) {
        // The reference: elements at (x, z), rotated; v and w by the forces -mu g u / |u|, over all elements.
        double v = start.speed, w = start.spin, angle = 0.0, way = 0.0, time = 0.0;
        for (; v > 0.02 || w > 0.2; time += dt) {
            double force = 0.0, torque = 0.0;
            constexpr int bits = 20;
            for (int i = 0; i < bits; ++i)
                for (int k = 0; k < bits; ++k) {
                    const double p = side * ((i + 0.5) / bits - 0.5), q = side * ((k + 0.5) / bits - 0.5);
                    const double x = p * std::cos(angle) - q * std::sin(angle),
                                 z = p * std::sin(angle) + q * std::cos(angle);
                    const double sx = v + w * z, sz = -w * x, share = -mu * g / (bits * bits) / std::hypot(sx, sz);
                    force += share * sx;
                    torque += share * (z * sx - x * sz);
                }
            way += (v + 0.5 * force * dt) * dt;
            angle -= w * dt;
            v += force * dt;
            w += torque / inertia * dt;
        }
        for (const auto solver :
             {ContactSolverChoice::by_island, ContactSolverChoice::soft, ContactSolverChoice::direct})
            for (const int steps : {1, 4, 16}) {
                if (solver == ContactSolverChoice::direct && steps == 1)
                    continue;  // rotates too far in a step for one solve
                SceneDescription scene = ground_scene(0.0, mu, steps);
                scene.simulation.contact_solver = solver;
                BodyDescription& plate = add_box(scene, {side, 0.01, side}, {0.0, 0.005, 0.0});
                plate.friction = mu;
                plate.velocity = {start.speed, 0.0, 0.0};
                plate.angular_velocity = {0.0, start.spin, 0.0};
                World world(scene);
                int sliding = 0;  // number of frames
                for (int frame = 1; frame < 180; ++frame) {
                    world.advance_frame();
                    if (world.snapshot().bodies[1].velocity.norm() > 0.02) sliding = frame;
                }
                const Vec3 x = world.snapshot().bodies[1].center_of_mass;
                // With one ellipsoid for all ratios of spin to slip the displacements are up to 16 % too short.
                EXPECT_NEAR(x.x(), way, 0.02 * way + start.speed / (60.0 * steps))
                    << start.speed << ' ' << start.spin << ' ' << int(solver) << ' ' << steps;
                EXPECT_NEAR(x.z(), 0.0, 0.02 * way)
                    << start.speed << ' ' << start.spin << ' ' << int(solver) << ' ' << steps;
                EXPECT_NEAR(sliding / 60.0, time, 0.12 * time)
                    << start.speed << ' ' << start.spin << ' ' << int(solver) << ' ' << steps;
            }
    }
}

}  // namespace tumble::friction_test
