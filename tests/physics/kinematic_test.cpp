// Kinematic bodies: they pass smoothly through their keyframes, ignore impulses, and carry bodies that stand on them.
#include "sim/math/keyframe_track.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace tumble::kinematic_test {
using namespace tumble::testing;

namespace {

KeyframeTrack track(Interpolation interpolation = Interpolation::smooth) {
    return KeyframeTrack({{0.0, {0, 0, 0}, Quat::Identity()},
                          {1.0, {1, 0, 0}, turn({0, 1, 0}, 0.5)},
                          {1.5, {1, 2, 0}, turn({0, 1, 1}, 1.2)},
                          {3.0, {4, 2, 1}, turn({1, 1, 0}, 2.0)}},
                         interpolation);
}

// A table about the origin, its top at y = 0, that rotates steadily (rad/s) for this time (s).
BodyDescription& add_turntable(SceneDescription& scene, double size, double speed, double seconds) {
    BodyDescription& table = add_box(scene, {size, 0.2, size}, {0.0, -0.1, 0.0});
    table.type = BodyType::kinematic;
    table.interpolation = Interpolation::linear;
    table.friction = 0.8;
    for (int i = 0; i * 0.5 <= seconds + 1.0; ++i)
        table.keyframes.push_back({0.5 * i, table.position, turn(Vec3::UnitY(), 0.5 * speed * i)});
    return table;
}

constexpr ContactSolverChoice both_solvers[] = {ContactSolverChoice::soft, ContactSolverChoice::direct};

}  // namespace

TEST(Keyframes, PassThroughTheKeys) {
    for (const auto mode : {Interpolation::smooth, Interpolation::linear}) {
        const KeyframeTrack t = track(mode);
        EXPECT_LT((t.at(1.0).position - Vec3(1, 0, 0)).norm(), 1e-14);
        EXPECT_LT((t.at(1.5).position - Vec3(1, 2, 0)).norm(), 1e-14);
        EXPECT_LT(t.at(1.5).rotation.angularDistance(turn({0, 1, 1}, 1.2)), 1e-7);
        EXPECT_EQ(t.at(-1.0).position, Vec3::Zero());
        EXPECT_EQ(t.at(9.0).position, Vec3(4, 2, 1));
        EXPECT_TRUE(t.at(9.0).velocity.isZero(0.0));
    }
}

// The reported velocities are the derivatives of the poses, and continuous over the keys.
TEST(Keyframes, VelocitiesAreTheDerivativesAndDoNotJump) {
    const KeyframeTrack t = track();
    const double d = 1e-6;
    for (const double at : {0.0, 0.3, 1.0, 1.2, 1.5, 2.2, 2.9999}) {
        const auto before = t.at(at - d), now = t.at(at), after = t.at(at + d);
        EXPECT_LT(((after.position - before.position) / (2.0 * d) - now.velocity).norm(), 1e-4) << at;
        const Vec3 spin = rotation_vector(after.rotation * before.rotation.conjugate()) / (2.0 * d);
        EXPECT_LT((spin - now.angular_velocity).norm(), 1e-4) << at;
        EXPECT_LT((after.angular_velocity - before.angular_velocity).norm(), 1e-3) << at;
        EXPECT_LT((after.velocity - before.velocity).norm(), 1e-3) << at;
    }
}

// Uniformly spaced keys of a steady rotation give a steady rotation (away from the ends, where it starts and stops).
TEST(Keyframes, SteadyRotationStaysSteady) {
    std::vector<Keyframe> keys;
    for (int i = 0; i < 6; ++i) keys.push_back({0.5 * i, Vec3::Zero(), turn({0.3, 1.0, 0.2}, 1.5 * i)});
    const KeyframeTrack t(keys, Interpolation::smooth);
    for (double at = 0.5; at <= 2.0; at += 0.05) EXPECT_NEAR(t.at(at).angular_velocity.norm(), 3.0, 1e-9) << at;
}

TEST(Kinematic, ImpulsesDoNotMoveIt) {
    SceneDescription scene = empty_scene();
    BodyDescription& paddle = add_box(scene, {0.2, 1.0, 1.0}, Vec3::Zero());
    paddle.type = BodyType::kinematic;
    paddle.keyframes = {{0.0, Vec3::Zero(), Quat::Identity()}, {1.0, {1, 0, 0}, Quat::Identity()}};
    paddle.interpolation = Interpolation::linear;
    BodyDescription& ball = add_sphere(scene, 0.2, {0.6, 0.0, 0.0}, 50.0);
    ball.restitution = 1.0;
    World world(scene);
    run(world, scene, 0.9);
    EXPECT_LT((world.snapshot().bodies[0].center_of_mass - Vec3(0.9, 0, 0)).norm(), 1e-12);
    EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 2.0, 1e-9);  // twice the wall's speed, e = 1
    EXPECT_NEAR(world.snapshot().bodies[0].velocity.x(), 1.0, 1e-12);
}

TEST(Kinematic, PlatformCarriesABoxByFriction) {
    SceneDescription scene;
    BodyDescription& platform = add_box(scene, {3.0, 0.2, 3.0}, Vec3::Zero());
    platform.type = BodyType::kinematic;
    platform.friction = 0.8;
    platform.keyframes = {{0.0, Vec3::Zero(), Quat::Identity()}, {2.0, {2, 1, 0}, turn({0, 1, 0}, 1.0)}};
    add_box(scene, {0.4, 0.4, 0.4}, {0.5, 0.3, 0.0}).friction = 0.8;
    World world(scene);
    run(world, scene, 3.0);
    const Snapshot s = world.snapshot();
    const Vec3 expected = s.bodies[0].origin + s.bodies[0].orientation * Vec3(0.5, 0.3, 0.0);
    EXPECT_LT((s.bodies[1].center_of_mass - expected).norm(), 5e-3);
}

// Bodies on a turntable move with it: 2 m/s^2 are a quarter of the limit of friction.
TEST(Kinematic, NothingCreepsOffATurntable) {
    for (const auto solver : both_solvers) {
        for (const int steps : {1, 4}) {
            SceneDescription scene;
            scene.simulation.contact_solver = solver;
            scene.simulation.steps_per_frame = steps;
            const double speed = 2.0, radius = 0.5;
            add_turntable(scene, 3.0, speed, 10.0);
            BodyDescription& box = add_box(scene, {0.1, 0.1, 0.1}, {radius, 0.05, 0.0});
            box.friction = 0.8;
            box.velocity = {0.0, 0.0, -speed * radius};
            box.angular_velocity = {0.0, speed, 0.0};
            World world(scene);
            run(world, scene, 10.0);
            const Vec3 x = world.snapshot().bodies[1].center_of_mass;
            const Vec3 expected = turn(Vec3::UnitY(), 10.0 * speed) * Vec3(radius, 0.05, 0.0);
            // three revolutions; 0.2 m by tangents
            EXPECT_NEAR(std::hypot(x.x(), x.z()), radius, 2e-4) << int(solver) << ' ' << steps;
            EXPECT_LT((x - expected).norm(), 0.02 / (steps * steps)) << int(solver) << ' ' << steps;
        }
    }
}

// A ball that rolls on a turntable moves in a circle, two revolutions to the table's seven, from any start.
TEST(Kinematic, ABallOnATurntableRollsInACircle) {
    for (const auto solver : both_solvers) {
        SceneDescription scene;
        scene.simulation.contact_solver = solver;
        scene.simulation.steps_per_frame = 1;
        const double speed = 3.0, circling = speed * 2.0 / 7.0, radius = 0.1, pi = 3.14159265358979323846;
        add_turntable(scene, 20.0, speed, 2.0 * pi / circling);
        BodyDescription& ball = add_sphere(scene, radius, {1.0, radius, 0.0});
        ball.friction = 0.8;
        ball.velocity = {0.0, 0.0, -1.0};
        ball.angular_velocity = {(speed * 1.0 - 1.0) / radius, 0.0, 0.0};  // rolls without slipping
        World world(scene);
        const Vec3 center(1.0 - 1.0 / circling, radius, 0.0);
        for (int k = 0; k < int(60.0 * 2.0 * pi / circling); ++k) {
            world.step();
            EXPECT_NEAR((world.snapshot().bodies[1].center_of_mass - center).norm(), 1.0 / circling, 5e-4)
                << int(solver);
        }
    }
}

// A platform that rocks and shakes, at half the acceleration that would throw bodies off: they stay in place.
TEST(Kinematic, NothingCreepsOnARockingPlatform) {
    for (const auto solver : both_solvers) {
        SceneDescription scene;
        scene.simulation.contact_solver = solver;
        scene.simulation.steps_per_frame = 1;
        BodyDescription& platform = add_box(scene, {5.0, 0.2, 2.0}, {0.0, -0.1, 0.0});
        platform.type = BodyType::kinematic;
        platform.friction = 0.8;
        for (int i = 0; i <= 320; ++i) {  // a swing in two seconds, starting smoothly
            const double t = i / 40.0,
                         swing = std::min(1.0, t / 2.0) * std::sin(2.0 * 3.14159265358979323846 * 0.5 * t);
            platform.keyframes.push_back({t, Vec3(0.05 * swing, -0.1, 0.0), turn(Vec3::UnitZ(), 0.2 * swing)});
        }
        for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0})
            add_box(scene, {0.3, 0.3, 0.3}, {x, 0.15, 0.0}).friction = 0.8;
        World world(scene);
        run(world, scene, 8.0);
        for (std::size_t i = 1; i < scene.bodies.size(); ++i)
            EXPECT_LT((world.snapshot().bodies[i].center_of_mass - scene.bodies[i].position).norm(), 2e-3)
                << int(solver) << ' ' << i;
    }
}

// A paddle that rotates at omega hits a ball at rest at distance r from its axis: at e = 1 it leaves with 2 omega r
// along the face's normal. A body that the paddle meets within a step is carried along only until the step ends; it
// must not be carried half a turn without an impact.
TEST(Kinematic, ARotatingPaddleHitsTheBodiesItMeets) {
    for (const double restitution : {0.1, 0.5, 1.0})
        for (const int steps : {4, 8, 16}) {
            SceneDescription scene = empty_scene(steps);
            BodyDescription& paddle = add_box(scene, {3.0, 0.4, 0.02}, Vec3::Zero());
            paddle.type = BodyType::kinematic;
            paddle.interpolation = Interpolation::linear;
            for (int i = 0; i < 4; ++i)
                paddle.keyframes.push_back({0.25 * i, Vec3::Zero(), turn(Vec3::UnitY(), 0.5 * std::numbers::pi * i)});
            add_sphere(scene, 0.1, {1.0, 0.0, -1.0});
            for (BodyDescription& body : scene.bodies) body.restitution = restitution;
            World world(scene);
            run(world, scene, 0.5);
            // The impact occurs when the center is its radius and half the thickness from the middle plane; the ball is
            // smooth.
            const double arm = std::sqrt(2.0 - 0.11 * 0.11), speed = (1.0 + restitution) * 2.0 * std::numbers::pi * arm;
            const double turned = std::numbers::pi / 4.0 - std::asin(0.11 / std::sqrt(2.0));
            const Vec3 normal = Vec3(-std::sin(turned), 0.0, -std::cos(turned));
            const BodyState ball = world.snapshot().bodies[1];
            EXPECT_LT((ball.velocity - speed * normal).norm(), 0.13 * speed / steps) << restitution << ' ' << steps;
        }
}

}  // namespace tumble::kinematic_test
