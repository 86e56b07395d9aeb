// Kinematic bodies: smooth through their keyframes, deaf to impulses, and they carry what stands on them.
#include "sim/keyframe_track.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

using namespace tumble;
using namespace tumble::testing;

namespace {

KeyframeTrack track(Interpolation interpolation = Interpolation::smooth) {
    return KeyframeTrack({{0.0, {0, 0, 0}, Quat::Identity()},
                          {1.0, {1, 0, 0}, turn({0, 1, 0}, 0.5)},
                          {1.5, {1, 2, 0}, turn({0, 1, 1}, 1.2)},
                          {3.0, {4, 2, 1}, turn({1, 1, 0}, 2.0)}},
                         interpolation);
}

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

// Evenly spaced keys of a steady turn give a steady turn (away from the ends, where it starts and stops).
TEST(Keyframes, SteadyTurnStaysSteady) {
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
    EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 2.0, 1e-9);   // twice the wall's speed, e = 1
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
