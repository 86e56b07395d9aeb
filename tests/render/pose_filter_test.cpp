// Movements that are too small to draw.
#include "example_scenes.h"

#include "render/scene/pose_filter.h"

#include <gtest/gtest.h>

namespace tumble::pose_filter_test {
namespace {

// A box of 1 m, 8 m away from the eye.
SceneDescription one_box() {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane(), box_body(Vec3(0.0, 1.0, 0.0), Vec3::Ones(), {200, 100, 50})};
    return scene;
}

double pixel_at_box(const SceneDescription& scene) {
    const Camera view(scene.camera, scene.output.width, scene.output.height);
    return view.pixel_size() * (8.0 - std::sqrt(0.75));
}

TEST(PoseFilter, FollowsMovementsAboveTheTolerance) {
    const SceneDescription scene = one_box();
    const double pixel = pixel_at_box(scene);
    for (const bool far : {false, true}) {
        PoseFilter poses(scene);
        Snapshot snapshot = first_snapshot(scene);
        EXPECT_TRUE(poses.follow(snapshot)) << "the first frame is new";
        EXPECT_FALSE(poses.follow(snapshot));
        const Vec3 before = snapshot.bodies[1].origin;
        snapshot.bodies[1].origin.x() += (far ? 1.01 : 0.99) * drawn_tolerance * pixel;
        EXPECT_EQ(poses.follow(snapshot), far);
        EXPECT_EQ(snapshot.bodies[1].origin == before, !far);
    }
}

// A scene without bodies: only the first frame is drawn.
TEST(PoseFilter, ASceneWithoutBodiesIsDrawnOnce) {
    const SceneDescription scene = empty_scene();
    PoseFilter poses(scene);
    Snapshot snapshot = first_snapshot(scene);
    EXPECT_TRUE(poses.follow(snapshot));
    EXPECT_FALSE(poses.follow(snapshot));
}

TEST(PoseFilter, MeasuresRotationsByTheFarthestPoint) {
    const SceneDescription scene = one_box();
    const double reach = 2.0 * std::sqrt(0.75);
    for (const bool far : {false, true}) {
        PoseFilter poses(scene);
        Snapshot snapshot = first_snapshot(scene);
        poses.follow(snapshot);
        const double length =
            (far ? 1.01 : 0.99) * drawn_tolerance * pixel_at_box(scene) / reach;  // of dq = 2 sin(a / 4)
        snapshot.bodies[1].orientation = Quat(Eigen::AngleAxisd(4.0 * std::asin(0.5 * length), Vec3::UnitY()));
        snapshot.bodies[1].orientation.coeffs() *= -1.0;  // the same rotation
        EXPECT_EQ(poses.follow(snapshot), far);
    }
}

// Small steps add up: a drawn pose never differs from the true one by more than the tolerance.
TEST(PoseFilter, StaysWithinTheToleranceOfASlowMovement) {
    const SceneDescription scene = one_box();
    const double most = drawn_tolerance * pixel_at_box(scene);
    PoseFilter poses(scene);
    Vec3 truth = Vec3(0.0, 1.0, 0.0);
    int followed = 0;
    for (int i = 0; i < 100; ++i) {
        Snapshot snapshot = first_snapshot(scene);
        snapshot.bodies[1].origin = truth;
        followed += poses.follow(snapshot);
        EXPECT_LE((snapshot.bodies[1].origin - truth).norm(), most * 1.0001);
        truth.y() += 0.3 * most;
    }
    EXPECT_NEAR(followed, 25, 1);
}

TEST(PoseFilter, MovesPlanesExactlyAndIgnoresHiddenBodies) {
    SceneDescription scene = one_box();
    scene.bodies[1].appearance.visible = false;
    PoseFilter poses(scene);
    Snapshot snapshot = first_snapshot(scene);
    poses.follow(snapshot);
    snapshot.bodies[1].origin.x() += 1.0;
    EXPECT_FALSE(poses.follow(snapshot)) << "an invisible body changes no picture";
    snapshot.bodies[0].origin.y() += 1e-9;
    EXPECT_TRUE(poses.follow(snapshot)) << "a plane is infinite";
}

TEST(PoseFilter, AnInvisibleBodyMovesItsCord) {
    SceneDescription scene = one_box();
    scene.bodies[1].appearance.visible = false;
    scene.cords.push_back({1, Vec3::Zero(), Vec3(0.0, 3.0, 0.0), 0.02, {60, 60, 60}});
    PoseFilter poses(scene);
    Snapshot snapshot = first_snapshot(scene);
    poses.follow(snapshot);
    snapshot.bodies[1].origin.x() += 0.1;
    EXPECT_TRUE(poses.follow(snapshot));
}

}  // namespace
}  // namespace tumble::pose_filter_test
