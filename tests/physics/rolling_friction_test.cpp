// Balls with rolling and spinning friction against closed forms, for each solver and with exact impacts.
#include "core/deterministic_math.h"
#include "support/compounds.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::rolling_friction_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81, radius = 0.1, mu = 0.8;

struct Way {
    const char* name;
    ContactSolverChoice solver;
    ImpactMode impacts;
};
constexpr Way ways[] = {{"direct", ContactSolverChoice::direct, ImpactMode::stepped},
                        {"soft", ContactSolverChoice::soft, ImpactMode::stepped},
                        {"exact impacts", ContactSolverChoice::by_island, ImpactMode::exact}};

// A ball of 2 kg on a plane, tilted by an angle about z.
SceneDescription ball_on_plane(const Way& way, double rolling, double spinning, double slope = 0.0) {
    SceneDescription scene = ground_scene(0.0, mu);
    scene.simulation.contact_solver = way.solver;
    scene.simulation.impacts = way.impacts;
    const SinCos tilt = sincos(slope);
    scene.simulation.gravity = {g * tilt.sin, -g * tilt.cos, 0.0};
    BodyDescription& ball = add_sphere(scene, radius, {0.0, radius, 0.0}, 2.0);
    ball.friction = mu;
    ball.rolling_friction = rolling;
    ball.spinning_friction = spinning;
    return scene;
}

void roll(BodyDescription& ball, double speed) {
    ball.velocity = {speed, 0.0, 0.0};
    ball.angular_velocity = {0.0, 0.0, -speed / radius};
}

}  // namespace

// The torque c N r brakes a rolling ball by 5 c g / 7.
TEST(RollingFriction, ABallStopsAfterItsDistance) {
    constexpr double v = 1.0, c = 0.1, distance = 7.0 * v * v / (10.0 * c * g);
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        SceneDescription scene = ball_on_plane(way, c, 0.0);
        roll(scene.bodies[1], v);
        World world(scene);
        run(world, scene, 0.5);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), v - 5.0 / 7.0 * c * g * 0.5, 2e-3);
        run(world, scene, 1.5);
        const Vec3 end = world.snapshot().bodies[1].origin;
        EXPECT_NEAR(end.x(), distance, 2e-3 * distance);
        EXPECT_NEAR(end.z(), 0.0, 1e-6);
        run(world, scene, 2.0);
        EXPECT_NEAR(world.snapshot().bodies[1].origin.x(), end.x(), 1e-5);
    }
}

TEST(RollingFriction, TheDistanceDoesNotDependOnTheStep) {
    constexpr double v = 1.0, c = 0.1, distance = 7.0 * v * v / (10.0 * c * g);
    for (const int steps : {4, 64}) {
        SceneDescription scene = ball_on_plane(ways[0], c, 0.0);
        scene.simulation.steps_per_frame = steps;
        roll(scene.bodies[1], v);
        World world(scene);
        run(world, scene, 2.0);
        EXPECT_NEAR(world.snapshot().bodies[1].origin.x(), distance, v / (60.0 * steps)) << steps;
    }
}

TEST(RollingFriction, HoldsABallOnAGentleSlopeAndBrakesItOnASteepOne) {
    constexpr double slope = 0.05;
    const SinCos tilt = sincos(slope);
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        SceneDescription holds = ball_on_plane(way, 0.06, 0.0, slope), rolls = ball_on_plane(way, 0.04, 0.0, slope);
        World held(holds), rolling(rolls);
        run(held, holds, 1.0);
        run(rolling, rolls, 1.0);
        EXPECT_LT(held.snapshot().bodies[1].origin.x(), 2e-5);
        const double a = 5.0 / 7.0 * g * (tilt.sin - 0.04 * tilt.cos);
        EXPECT_NEAR(rolling.snapshot().bodies[1].velocity.x(), a, 0.01 * a);
    }
}

TEST(RollingFriction, SpinningFrictionStopsASpin) {
    constexpr double w = 10.0, s = 0.01, rate = s * g / (0.4 * radius * radius);
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        SceneDescription scene = ball_on_plane(way, 0.0, s);
        scene.bodies[1].angular_velocity = {0.0, w, 0.0};
        World world(scene);
        run(world, scene, 0.2);
        EXPECT_NEAR(world.snapshot().bodies[1].angular_velocity.y(), w - 0.2 * rate, 0.02);
        run(world, scene, 0.4);
        EXPECT_NEAR(world.snapshot().bodies[1].angular_velocity.norm(), 0.0, 1e-6);
    }
}

TEST(RollingFriction, TheEnergyIsBookedAsFriction) {
    for (const Way& way : ways) {
        SCOPED_TRACE(way.name);
        SceneDescription scene = ball_on_plane(way, 0.1, 0.01);
        roll(scene.bodies[1], 1.0);
        scene.bodies[1].angular_velocity.y() = 5.0;
        const double start = 0.5 * 2.0 * (7.0 / 5.0 + 0.4 * radius * radius * 25.0);
        World world(scene);
        world.record_energy();
        run(world, scene, 2.0);
        const EnergyLedger lost = world.contact_records().energy;
        EXPECT_NEAR(lost.friction_loss + lost.impact_loss, start, 1e-4 * start);
        EXPECT_NEAR(lost.friction_loss, start, 0.01 * start);
    }
}

// Two balls that roll on each other have the radius r / 2; parts of compounds have their own.
TEST(RollingFriction, PartsRollAsBalls) {
    SceneDescription scene = ball_on_plane(ways[0], 0.1, 0.0), alone = scene;
    CompoundPart part;
    part.shape = SphereShape{radius};
    scene.bodies[1].shape = CompoundShape{std::make_shared<const std::vector<CompoundPart>>(1, part)};
    for (SceneDescription* one : {&scene, &alone}) roll(one->bodies[1], 1.0);
    World compound(scene), ball(alone);
    run(compound, scene, 1.0);
    run(ball, alone, 1.0);
    EXPECT_NEAR(compound.snapshot().bodies[1].origin.x(), ball.snapshot().bodies[1].origin.x(), 1e-6);
}

TEST(RollingFriction, AFixedBodyWithoutAValueTakesThatOfTheBall) {
    SceneDescription scene = ball_on_plane(ways[0], 0.1, 0.0), none = scene;
    none.bodies[0].rolling_friction = 0.0;
    for (SceneDescription* one : {&scene, &none}) roll(one->bodies[1], 1.0);
    World braked(scene), free(none);
    run(braked, scene, 1.0);
    run(free, none, 1.0);
    EXPECT_LT(braked.snapshot().bodies[1].velocity.x(), 0.5);
    EXPECT_NEAR(free.snapshot().bodies[1].velocity.x(), 1.0, 1e-9);
}

}  // namespace tumble::rolling_friction_test
