// Explosions against solid angles in closed form, and conservation laws.
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tumble::explosion_test {
using namespace tumble::testing;

namespace {

constexpr double pi = std::numbers::pi, impulse = 12.0;

SceneDescription space() {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3::Zero();
    return scene;
}

void explode(SceneDescription& scene, const Vec3& center, double time = 0.0) {
    scene.explosions.push_back({center, time, impulse, infinity});
}

Snapshot after_a_frame(const SceneDescription& scene) {
    World world(scene);
    world.advance_frame();
    return world.snapshot();
}

// A ball of the half angle a takes I / 4 sin^2 a.
TEST(Explosion, ABallTakesItsSolidAngle) {
    for (const double radius : {0.01, 0.5, 1.9}) {
        SceneDescription scene = space();
        add_sphere(scene, radius, {0.0, 2.0, 0.0});
        explode(scene, Vec3::Zero());
        const double sine = radius / 2.0;
        EXPECT_NEAR(after_a_frame(scene).bodies[0].momentum.y(), impulse / 4.0 * sine * sine, 1e-14);
    }
}

// The view factor of a square plate from a parallel element opposite its center (Howell, "Radiation Configuration
// Factors", B-3): pi F is the integral of cos over its solid angle.
TEST(Explosion, ABoxTakesTheSolidAngleOfItsFace) {
    for (const double distance : {0.05, 0.5, 4.0}) {
        SceneDescription scene = space();
        add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.0, -0.5 - distance});
        explode(scene, Vec3::Zero());
        const double a = 0.5 / distance, root = std::sqrt(1.0 + a * a);
        const double view = 4.0 / pi * a / root * std::atan(a / root);
        const BodyState state = after_a_frame(scene).bodies[0];
        EXPECT_NEAR(state.momentum.z(), -impulse / 4.0 * view, 1e-13);
        EXPECT_NEAR(state.angular_momentum.norm(), 0.0, 1e-14);
    }
}

// Seen along its axis, a cylinder is a disc; the outline is a polygon around it.
TEST(Explosion, ACylinderTakesTheSolidAngleOfItsEnd) {
    SceneDescription scene = space();
    CurvedShape cylinder;
    cylinder.radius = cylinder.top_radius = 0.5;
    cylinder.height = 2.0;
    add_body(scene, cylinder, {0.0, 3.0, 0.0});
    explode(scene, Vec3::Zero());
    const double sine = std::sin(std::atan(0.5 / 2.0)), expected = impulse / 4.0 * sine * sine;
    const double found = after_a_frame(scene).bodies[0].momentum.y();
    EXPECT_NEAR(found, expected, 4e-4 * expected);
    EXPECT_NE(found, expected);
}

// Bodies all around the center: equal ones opposite each other leave no momentum. The impulse acts along a line through
// the center, so that no body gets angular momentum about it, wherever it is and however it is turned.
TEST(Explosion, ConservesMomentumBySymmetryAndAngularMomentumAlways) {
    SceneDescription scene = space();
    const Vec3 center{0.3, 1.0, -0.2};
    const Quat turned = from_rotation_vector(Vec3(0.3, -0.7, 0.4));
    for (const Vec3& place : {Vec3(1.0, 0.2, 0.3), Vec3(-0.4, 1.1, 0.2), Vec3(0.3, -0.2, 1.2)})
        for (const double side : {1.0, -1.0}) add_box(scene, {0.4, 0.7, 0.3}, center + side * place).rotation = turned;
    explode(scene, center);
    const Snapshot snapshot = after_a_frame(scene);
    const double h = 1.0 / scene.output.fps;
    Vec3 sum = Vec3::Zero();
    for (const BodyState& body : snapshot.bodies) {
        sum += body.momentum;
        EXPECT_GT(body.momentum.norm(), 0.01);
        EXPECT_GT(body.angular_momentum.norm(), 1e-4);
        const Vec3 start = body.center_of_mass - h * body.velocity - center;
        EXPECT_NEAR((start.cross(body.momentum) + body.angular_momentum).norm(), 0.0, 1e-13);
    }
    EXPECT_NEAR(sum.norm(), 0.0, 1e-14);
}

TEST(Explosion, EveryIntegratorTakesTheWholeImpulse) {
    for (const IntegratorKind kind : {IntegratorKind::symplectic_euler, IntegratorKind::explicit_euler,
                                      IntegratorKind::splitting, IntegratorKind::runge_kutta_4, IntegratorKind::exact})
        for (const double time : {0.1, 0.1001, 0.1 + 0.999 / 960.0}) {
            SceneDescription scene = space();
            scene.simulation.integrator = kind;
            add_sphere(scene, 0.5, {0.0, 2.0, 0.0});
            explode(scene, Vec3::Zero(), time);
            World world(scene);
            for (int n = 0; n < 6; ++n) world.advance_frame();
            EXPECT_EQ(world.snapshot().bodies[0].momentum, Vec3::Zero().eval());
            world.advance_frame();
            world.advance_frame();
            EXPECT_NEAR(world.snapshot().bodies[0].momentum.y(), impulse / 64.0, 1e-13) << int(kind) << " " << time;
        }
}

TEST(Explosion, WakesAStackAndItsWorkIsItsEnergy) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    scene.simulation.sleep = true;
    add_box(scene, {0.4, 0.4, 0.4}, {0.0, 0.2, 0.0});
    add_box(scene, {0.4, 0.4, 0.4}, {0.0, 0.6, 0.0});
    explode(scene, {-1.0, 0.5, 0.0}, 2.0);
    World world(scene);
    for (int n = 0; n < 120; ++n) world.advance_frame();
    ASSERT_TRUE(world.snapshot().bodies[2].asleep);
    world.advance_frame();
    EXPECT_FALSE(world.snapshot().bodies[1].asleep);
    EXPECT_GT(world.snapshot().bodies[2].velocity.x(), 0.05);
}

TEST(Explosion, NothingBeyondTheRadiusOrAroundTheCenter) {
    SceneDescription scene = space();
    add_sphere(scene, 0.5, {0.0, 2.0, 0.0});
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.1, 0.0});
    explode(scene, Vec3::Zero());
    scene.explosions[0].radius = 2.0;
    const Snapshot snapshot = after_a_frame(scene);
    EXPECT_EQ(snapshot.bodies[0].momentum, Vec3::Zero().eval());
    EXPECT_EQ(snapshot.bodies[1].momentum, Vec3::Zero().eval());
    scene.explosions[0].radius = 4.0;
    EXPECT_NEAR(after_a_frame(scene).bodies[0].momentum.y(), impulse / 64.0 * 0.5625, 1e-14);
}

}  // namespace
}  // namespace tumble::explosion_test
