// Motion compared with points that are moved and projected independently; and detection of equal frames.
#include "world_rays.h"

#include "render/camera/camera_animation.h"

#include <gtest/gtest.h>

namespace tumble::aov_motion_test {
namespace {

constexpr double tolerance = 2e-5;  // pixels: depth and the result have single precision

struct Moving {
    SceneDescription scene;
    Snapshot now, next;
};

AovFrame made(const Moving& m) {
    AovSet aovs;
    for (const Aov aov : all_aovs) aovs.add(aov);
    return AovRenderer(m.scene, aovs).make({m.now, m.next});
}

/// A box that flies and tumbles, a ball that only rotates, and the ground.
Moving moving_bodies() {
    Moving m;
    m.scene = empty_scene();
    m.scene.bodies = {ground_plane(), box_body(Vec3(-1.0, 1.2, 0.0), Vec3(1.0, 1.5, 2.0), {}),
                      ball_body(Vec3(1.5, 1.0, 1.0), 0.7, {})};
    m.now = m.next = first_snapshot(m.scene);
    m.next.frame = 1;
    m.next.time = 1.0 / 60.0;
    m.next.bodies[1].origin += Vec3(0.2, -0.3, 0.4);
    m.next.bodies[1].orientation = Quat(Eigen::AngleAxisd(0.2, Vec3(1.0, -1.0, 0.3).normalized()));
    m.next.bodies[2].orientation = Quat(Eigen::AngleAxisd(-0.3, Vec3::UnitY()));
    return m;
}

/// Each pixel's point, moved with its body independently and projected into the next frame.
void expect_motion(const Moving& m) {
    const AovFrame frame = made(m);
    const CameraAnimation path(m.scene.camera);
    const WorldView view(m.scene, path.at(m.now)), next_view(m.scene, path.at(m.next));
    std::vector<int> seen(m.scene.bodies.size() + 1);
    for (int row = 0; row < m.scene.output.height; ++row)
        for (int column = 0; column < m.scene.output.width; ++column) {
            const auto pixel = std::size_t(row * m.scene.output.width + column);
            const auto id = std::size_t(frame.segmentation[pixel]);
            ++seen[id];
            const WorldRay ray = view.ray(column, row);
            Eigen::Vector2d place;
            if (id == 0) {
                place = next_view.place(next_view.eye + ray.direction);
            } else {
                const BodyState &now = m.now.bodies[id - 1], &next = m.next.bodies[id - 1];
                const double depth = nearest_in_world(m.scene, m.now, ray).first;
                const Vec3 on_body = now.orientation.conjugate() * (ray.at(depth) - now.origin);
                place = next_view.place(next.origin + next.orientation * on_body);
            }
            const Eigen::Vector2d expected = place - Eigen::Vector2d(column, row);
            const double near = tolerance + 1e-6 * expected.norm();
            ASSERT_NEAR(frame.motion[2 * pixel], expected.x(), near) << column << " " << row << " id " << id;
            ASSERT_NEAR(frame.motion[2 * pixel + 1], expected.y(), near) << column << " " << row << " id " << id;
        }
    for (const int pixels : seen) EXPECT_GT(pixels, 500);
}

TEST(AovMotion, OfMovingBodies) { expect_motion(moving_bodies()); }

TEST(AovMotion, OfAnOrbitingCamera) {
    Moving m = moving_bodies();
    m.scene.camera.orbit = 180.0;  // 3 degrees a frame
    expect_motion(m);
    m.next.bodies = m.now.bodies;
    expect_motion(m);
}

TEST(AovMotion, OfAZoom) {
    Moving m = moving_bodies();
    m.scene.camera.keyframes = {{0.0, m.scene.camera.eye, m.scene.camera.target, 40.0},
                                {1.0 / 60.0, m.scene.camera.eye + Vec3(0.1, 0.0, 0.2), m.scene.camera.target, 35.0}};
    expect_motion(m);
}

TEST(AovMotion, OfACameraThatFollows) {
    Moving m = moving_bodies();
    m.scene.camera.follow = 1;
    m.scene.camera.follow_start = m.now.bodies[1].origin;
    expect_motion(m);
}

TEST(AovMotion, IsZeroToTheBitWhereNothingMoves) {
    const Moving m = moving_bodies();
    const AovFrame frame = made(m);
    for (std::size_t i = 0; i < frame.segmentation.size(); ++i) {
        if (frame.segmentation[i] > 1) continue;
        EXPECT_EQ(frame.motion[2 * i], 0.0f);
        EXPECT_EQ(frame.motion[2 * i + 1], 0.0f);
    }
}

TEST(AovMotion, IsNaNWhereThePointGoesBehindTheEye) {
    Moving m = moving_bodies();
    m.next.bodies[2].origin.z() = 20.0;
    const AovFrame frame = made(m);
    int pixels = 0;
    for (std::size_t i = 0; i < frame.segmentation.size(); ++i) {
        EXPECT_EQ(std::isnan(frame.motion[2 * i]), frame.segmentation[i] == 3);
        EXPECT_EQ(std::isnan(frame.motion[2 * i + 1]), frame.segmentation[i] == 3);
        if (frame.segmentation[i] == 3) ++pixels;
    }
    EXPECT_GT(pixels, 500);
}

TEST(AovMotion, ACordIsCarriedByItsShareOfTheLength) {
    Moving m = moving_bodies();
    const Vec3 anchor(0.0, 3.0, 0.0);
    m.scene.cords.push_back({1, Vec3::Zero(), anchor, 1e-3, {}});  // so thin that its points are on the axis
    m.scene.output.width = 1280;
    m.scene.output.height = 720;
    const AovFrame frame = made(m);
    const WorldView view(m.scene);
    const Vec3 along = m.now.bodies[1].origin - anchor, next_along = m.next.bodies[1].origin - anchor;
    int pixels = 0;
    for (int row = 0; row < 720; ++row)
        for (int column = 0; column < 1280; ++column) {
            const auto pixel = std::size_t(row * 1280 + column);
            if (frame.segmentation[pixel] != 4) continue;
            ++pixels;
            const double share =
                (view.ray(column, row).at(frame.depth[pixel]) - anchor).dot(along) / along.squaredNorm();
            const Eigen::Vector2d expected =
                view.place(anchor + share * next_along) - view.place(anchor + share * along);
            EXPECT_NEAR(frame.motion[2 * pixel], expected.x(), 0.1);
            EXPECT_NEAR(frame.motion[2 * pixel + 1], expected.y(), 0.1);
        }
    EXPECT_GT(pixels, 20);
}

TEST(AovChanges, TellsFramesThatAreTheSame) {
    const Moving m = moving_bodies();
    AovChanges changes(m.scene);
    EXPECT_TRUE(changes.follow({m.now, m.next})) << "the first";
    EXPECT_TRUE(changes.follow({m.next, m.next})) << "it moved";
    EXPECT_FALSE(changes.follow({m.next, m.next}));
    EXPECT_TRUE(changes.follow({m.next, m.now})) << "it will move";
    Snapshot trembling = m.now;
    trembling.bodies[2].origin.x() += 1e-12;
    EXPECT_TRUE(changes.follow({m.now, std::nullopt}));
    EXPECT_TRUE(changes.follow({trembling, std::nullopt}));

    SceneDescription turning = m.scene;
    turning.camera.orbit = 1.0;
    AovChanges with_camera(turning);
    EXPECT_TRUE(with_camera.follow({m.now, std::nullopt}));
    Snapshot later = m.now;
    later.time = 1.0;
    EXPECT_TRUE(with_camera.follow({later, std::nullopt}));
    EXPECT_FALSE(with_camera.follow({later, std::nullopt}));
}

}  // namespace
}  // namespace tumble::aov_motion_test
