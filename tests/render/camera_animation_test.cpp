// Pose of a moving camera compared with closed forms; and its frames.
#include "drawing.h"
#include "example_scenes.h"

#include "render/camera/camera.h"
#include "render/camera/camera_animation.h"
#include "render/render_scene_builder.h"
#include "render/scene/fog_distance.h"
#include "render/scene/pose_filter.h"
#include "render/scene/render_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::camera_animation_test {
namespace {

constexpr double rounding = 1e-12;  // m, at the distances of these scenes

Snapshot at_time(const SceneDescription& scene, double time) {
    Snapshot snapshot = first_snapshot(scene);
    snapshot.time = time;
    return snapshot;
}

/// Ground, a heap of boxes, and the camera of empty_scene(): at (0, 1, 8), to (0, 1, 0).
SceneDescription small_heap() {
    SceneDescription scene = heap_scene(12);
    scene.output.width = 232;
    scene.output.height = 152;
    return scene;
}

TEST(CameraAnimation, StandsStillWhereNothingMovesIt) {
    const SceneDescription scene = empty_scene();
    EXPECT_TRUE(same_place(CameraAnimation(scene.camera).at(at_time(scene, 3.0)), scene.camera));
}

TEST(CameraAnimation, TurnsAboutTheTargetCounterClockwiseFromAbove) {
    SceneDescription scene = empty_scene();
    scene.camera.orbit = 30.0;
    const CameraAnimation path(scene.camera);
    for (const double time : {0.0, 1.0, 3.0, 4.5, 10.0}) {
        const double angle = M_PI / 6.0 * time;
        const CameraDescription now = path.at(at_time(scene, time));
        EXPECT_LT((now.eye - Vec3(8.0 * std::sin(angle), 1.0, 8.0 * std::cos(angle))).norm(), rounding) << time;
        EXPECT_EQ(now.target, scene.camera.target);
    }
    EXPECT_EQ(path.at(at_time(scene, 12.0)).eye, scene.camera.eye) << "to the last bit";
}

TEST(CameraAnimation, AnOrbitKeepsItsHeightAboutATiltedUp) {
    SceneDescription scene = empty_scene();
    scene.camera.up = Vec3(1.0, 2.0, 0.5);  // not normalized
    scene.camera.orbit = -77.0;
    const Vec3 arm = scene.camera.eye - scene.camera.target;
    const CameraDescription now = CameraAnimation(scene.camera).at(at_time(scene, 1.3));
    EXPECT_NEAR((now.eye - now.target).norm(), arm.norm(), rounding);
    EXPECT_NEAR((now.eye - now.target).dot(scene.camera.up), arm.dot(scene.camera.up), rounding);
}

TEST(CameraAnimation, GoesThroughItsKeyframes) {
    SceneDescription scene = empty_scene();
    scene.camera.keyframes = {
        {1.0, {0, 0, 8}, {0, 0, 0}, 40.0}, {2.0, {4, 0, 8}, {0, 2, 0}, 20.0}, {4.0, {4, 6, 8}, {0, 2, 2}, 30.0}};
    for (const Interpolation way : {Interpolation::linear, Interpolation::smooth}) {
        scene.camera.interpolation = way;
        const CameraAnimation path(scene.camera);
        for (const CameraKeyframe& key : scene.camera.keyframes) {
            const CameraDescription now = path.at(at_time(scene, key.time));
            EXPECT_LT((now.eye - key.eye).norm() + (now.target - key.target).norm(), rounding);
            EXPECT_NEAR(now.vertical_fov, key.vertical_fov, rounding);
        }
        EXPECT_EQ(path.at(at_time(scene, 0.2)).eye, Vec3(0, 0, 8)) << "still before the first";
        EXPECT_EQ(path.at(at_time(scene, 9.0)).eye, Vec3(4, 6, 8)) << "and after the last";
        const CameraDescription between = path.at(at_time(scene, 1.5));
        // Smooth: half of the displacement, less an eighth of the second key's velocity: (2 * 4 + 0, 0 + 6 / 2, 0) / 3.
        const bool smooth = way == Interpolation::smooth;
        EXPECT_LT((between.eye - (smooth ? Vec3(2.0 - 8.0 / 24.0, -1.0 / 8.0, 8.0) : Vec3(2, 0, 8))).norm(), rounding);
    }
}

// A waiting camera stands still, even if it leaves fast; its eye may wait while its target moves.
TEST(CameraAnimation, AWaitingCameraStandsStill) {
    SceneDescription scene = empty_scene();
    scene.camera.keyframes = {
        {0.0, {0, 0, 8}, {0, 0, 0}, 40.0}, {3.0, {0, 0, 8}, {2, 0, 0}, 40.0}, {3.2, {5, 0, 8}, {2, 1, 0}, 20.0}};
    const CameraAnimation path(scene.camera);
    for (double t = 0.0; t <= 3.0; t += 0.1) {
        const CameraDescription now = path.at(at_time(scene, t));
        EXPECT_EQ(now.eye, Vec3(0, 0, 8)) << t;
        EXPECT_EQ(now.vertical_fov, 40.0) << t;
    }
}

// Straight above its target, the camera keeps its roll of the moment before.
TEST(CameraAnimation, PassesOverItsTargetWithoutAQuarterTurn) {
    for (const double orbit : {0.0, 50.0})
        for (const double height : {8.0, -8.0})
            for (const Interpolation way : {Interpolation::linear, Interpolation::smooth}) {
                SceneDescription scene = empty_scene();
                scene.camera.up = Vec3(0.0, 2.0, 0.0);
                scene.camera.interpolation = way;
                scene.camera.orbit = orbit;
                scene.camera.keyframes = {{1.0, {2, height, 4}, {0, 0, 0}, 40.0},
                                          {3.0, {-2, height, -4}, {0, 0, 0}, 40.0}};
                const CameraAnimation path(scene.camera);
                const auto view_at = [&](double time) { return Camera(path.at(at_time(scene, time)), 320, 180); };
                const Camera before = view_at(2.0 - 1e-6), there = view_at(2.0), after = view_at(2.0 + 1e-6);
                EXPECT_LT((there.eye() - Vec3(0.0, height, 0.0)).norm(), rounding);
                // Nearly level, along (2, 4): up x forward is to the right, seen from above and from below.
                const double angle = orbit * M_PI / 180.0 * 2.0;
                const Vec3 right = Eigen::AngleAxisd(angle, Vec3::UnitY()) * Vec3(4.0, 0.0, -2.0).normalized();
                EXPECT_LT((there.right() - right).norm(), 1e-3) << orbit << " " << height;
                EXPECT_LT((there.right() - before.right()).norm(), 1e-3) << orbit << " " << height;
                EXPECT_LT((there.up() - before.up()).norm(), 1e-3) << orbit << " " << height;
                EXPECT_LT((after.right() + right).norm(), 1e-3) << "up is up again: half a turn";
            }
}

TEST(CameraAnimation, FollowsABodyAndTurnsAroundIt) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane(), ball_body(Vec3(1.0, 1.0, 0.0), 0.5, {200, 60, 50})};
    scene.camera.follow = 1;
    scene.camera.follow_start = scene.bodies[1].position;
    scene.camera.orbit = 90.0;
    Snapshot snapshot = at_time(scene, 1.0);
    snapshot.bodies[1].origin = snapshot.bodies[1].center_of_mass = Vec3(4.0, 3.0, -2.0);
    const CameraDescription now = CameraAnimation(scene.camera).at(snapshot);
    EXPECT_LT((now.eye - Vec3(8.0 + 3.0, 1.0 + 2.0, -2.0)).norm(), rounding);
    EXPECT_LT((now.target - Vec3(3.0, 3.0, -2.0)).norm(), rounding);
}

// The origin of the body is at one end, and the body tumbles about its center: the camera follows the center, in a
// straight line.
TEST(CameraAnimation, FollowsTheCenterOfMassOfATumblingBody) {
    SceneDescription scene = empty_scene();
    const Vec3 middle(0.3, 0.1, -0.2);  // body frame, from the origin
    const Quat first(Eigen::AngleAxisd(0.4, Vec3::UnitY()));
    scene.bodies = {box_body(Vec3(1.0, 2.0, 0.0), Vec3::Ones(), {200, 60, 50}, first)};
    scene.camera.follow = 0;
    scene.camera.follow_start = scene.bodies[0].position;
    scene.camera.follow_start_rotation = first;
    const CameraAnimation path(scene.camera);
    const Vec3 start = scene.bodies[0].position + first * middle;
    for (const double time : {0.0, 0.7, 2.0}) {
        Snapshot snapshot = at_time(scene, time);
        BodyState& body = snapshot.bodies[0];
        body.orientation = Quat(Eigen::AngleAxisd(3.0 * time, Vec3(1.0, 2.0, 0.5).normalized())) * first;
        body.center_of_mass = start + time * Vec3(2.0, -1.0, 0.5);
        body.origin = body.center_of_mass - body.orientation * middle;
        EXPECT_LT((path.carried(snapshot) - time * Vec3(2.0, -1.0, 0.5)).norm(), rounding) << time;
    }
}

TEST(MovingCamera, AFollowedBodyStaysAtItsPixel) {
    SceneDescription scene = empty_scene();
    scene.bodies = {ground_plane(), ball_body(Vec3(0.7, 1.0, 0.0), 0.4, {220, 30, 20})};
    scene.camera.follow = 1;
    scene.camera.follow_start = scene.bodies[1].position;
    Renderer renderer(scene);
    const Pixel middle = pixel_of(scene, scene.bodies[1].position), left = pixel_of(scene, Vec3(0.25, 1.0, 0.0));
    for (const double x : {0.0, 2.3, 40.0, 800.0}) {
        Snapshot snapshot = at_time(scene, 0.0);
        snapshot.bodies[1].origin = snapshot.bodies[1].center_of_mass += Vec3(x, 0.1 * x, -x);
        const Image& image = renderer.render(snapshot);
        const std::uint8_t *ball = image.at(middle.x, middle.y), *beside = image.at(left.x, left.y);
        EXPECT_GT(ball[0], 2 * ball[2]) << "red at " << x;
        EXPECT_LT(beside[0], 2 * beside[2]) << "not red beside it, at " << x;
    }
}

// Every frame equals that of a new renderer, for any subset of frames that the renderer gets.
TEST(MovingCamera, ChangesNoByteOfAFullRedraw) {
    SceneDescription scene = small_heap();
    const std::size_t last = scene.bodies.size() - 1;
    scene.camera.keyframes = {{0.5, scene.camera.eye, scene.camera.target, 40.0},
                              {0.9, scene.camera.eye + Vec3(1.0, 0.5, 0.0), scene.camera.target, 34.0}};
    scene.camera.follow = last;
    scene.camera.follow_start = scene.bodies[last].position;
    for (const bool turns : {false, true}) {
        scene.camera.orbit = turns ? 60.0 : 0.0;
        RenderSwitches everything;
        everything.full_redraw = true;
        Renderer partial(scene), every_other(scene), full(scene, everything);
        PoseFilter poses(scene);
        for (int n = 0; n < 15; ++n) {  // with still frames before and after
            Snapshot snapshot = at_time(scene, 0.1 * n);
            snapshot.bodies[1].origin.x() += 0.05 * n;
            if (n > 10)
                snapshot.bodies[last].origin = snapshot.bodies[last].center_of_mass += Vec3(0.1 * (n - 10), 0.2, 0.0);
            poses.follow(snapshot);
            const Image& truth = full.render(snapshot);
            ASSERT_EQ(partial.render(snapshot), truth) << n;
            if (n % 2 == 0) continue;
            ASSERT_EQ(every_other.render(snapshot), truth) << n;
        }
    }
}

// Data that is kept from another camera position equals, to the bit, data computed at this one: with a few hundred
// bodies, rounding would show in some texel.
TEST(MovingCamera, CachedDataDoesNotDependOnTheViewpoint) {
    SceneDescription scene = heap_scene(250);
    scene.output.width = 232;
    scene.output.height = 152;
    scene.camera.eye += 30.0 * (scene.camera.eye - scene.camera.target);  // a long lens: distances round coarsely
    scene.camera.vertical_fov = 1.3;
    scene.camera.orbit = 1.0;
    const std::vector<double> times = {0.0, 5.3, 9.1};
    std::vector<Image> images;
    {
        Renderer used(scene);
        for (const double time : times) images.push_back(used.render(at_time(scene, time)));
    }
    for (std::size_t i = 0; i < times.size(); ++i)
        EXPECT_EQ(images[i], drawn(scene, at_time(scene, times[i]))) << times[i];
}

TEST(MovingCamera, AWholeTurnComesBackToTheSameBytes) {
    SceneDescription scene = small_heap();
    scene.camera.orbit = 90.0;
    Renderer renderer(scene);
    const Image first = renderer.render(at_time(scene, 0.0));
    for (const double time : {1.0, 2.0, 3.0}) EXPECT_NE(renderer.render(at_time(scene, time)), first) << time;
    EXPECT_EQ(renderer.render(at_time(scene, 4.0)), first);
}

TEST(MovingCamera, NoTwoFramesAreTheSamePictureUntilItStops) {
    SceneDescription scene = small_heap();
    scene.camera.keyframes = {{0.0, scene.camera.eye, scene.camera.target, 40.0},
                              {1.0, scene.camera.eye + Vec3(1.0, 0.0, 0.0), scene.camera.target, 40.0}};
    PoseFilter poses(scene);
    for (int n = 0; n < 16; ++n) {
        Snapshot snapshot = at_time(scene, 0.1 * n);
        EXPECT_EQ(poses.follow(snapshot), n <= 10) << n;
    }
}

TEST(MovingCamera, StandsStillWithAJitteringBody) {
    SceneDescription scene = small_heap();
    scene.camera.follow = 1;
    scene.camera.follow_start = scene.bodies[1].position;
    scene.bodies[1].appearance.visible = false;  // followed although invisible
    PoseFilter poses(scene);
    Snapshot snapshot = at_time(scene, 0.0);
    poses.follow(snapshot);
    snapshot = at_time(scene, 0.1);
    snapshot.bodies[1].origin.x() += 1e-9;
    snapshot.bodies[1].center_of_mass.x() += 1e-9;
    EXPECT_FALSE(poses.follow(snapshot));
    EXPECT_EQ(snapshot.bodies[1].origin, scene.bodies[1].position);
    snapshot.bodies[1].origin.x() += 0.5;
    EXPECT_TRUE(poses.follow(snapshot));
}

// Fog and grids fit the bodies' distance: the target may be anywhere along the view axis, also in front of or behind
// the bodies.
TEST(FogReferenceDistance, IsTheDistanceOfTheBodiesInView) {
    SceneDescription scene = empty_scene();
    for (const double x : {-1.0, 0.0, 1.0}) scene.bodies.push_back(ball_body(Vec3(x, 0.0, 0.0), 0.5, {90, 90, 90}));
    const RenderScene render_scene = make_render_scene(scene);
    scene.camera.eye = Vec3(0.0, 0.0, 10.0);
    const auto with_target = [&](double z) {
        scene.camera.target = Vec3(0.0, 0.0, z);
        return viewing_distance(scene, render_scene);
    };
    EXPECT_EQ(with_target(0.0), 10.0);
    EXPECT_EQ(with_target(3.0), 7.0);
    EXPECT_NEAR(with_target(9.9), 5.0, 0.1);
    EXPECT_NEAR(with_target(-1000.0), 20.0, 0.2);
    scene.camera.keyframes = {{0.0, {0, 0, 5}, {0, 0, 0}, 40.0}, {2.0, {0, 0, 30}, {0, 0, 0}, 10.0}};
    EXPECT_EQ(viewing_distance(scene, render_scene), 30.0);
    scene.bodies.clear();
    scene.camera.keyframes.clear();
    scene.camera.target = Vec3(0.0, 0.0, 6.0);
    EXPECT_EQ(viewing_distance(scene, make_render_scene(scene)), 4.0);
}

// A tower behind marbles must be visible, although fog at five times their distance would hide it.
TEST(FogDistance, KeepsLargeBodiesVisible) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 0.0, 10.0);
    scene.camera.target = Vec3::Zero();
    for (const double x : {-1.0, 0.0, 1.0}) scene.bodies.push_back(ball_body(Vec3(x, 0.0, 0.0), 0.5, {90, 90, 90}));
    scene.bodies.push_back(box_body(Vec3::Zero(), Vec3::Ones(), {90, 90, 90}));
    const auto with_box = [&](const Vec3& position, double size) {
        scene.bodies[3].position = position;
        scene.bodies[3].shape = BoxShape{Vec3::Constant(size)};
        return fog_distance(scene, make_render_scene(scene), 10.0);
    };
    EXPECT_EQ(with_box(Vec3(1.0, 1.0, -1.0), 1.0), 50.0);        // near
    EXPECT_EQ(with_box(Vec3(0.0, 0.0, -190.5), 0.5), 50.0);      // small on the screen
    EXPECT_EQ(with_box(Vec3(0.0, 0.0, -195.0), 10.0), 400.0);    // its near side is 200 m away
    EXPECT_EQ(with_box(Vec3(0.0, 0.0, 215.0), 10.0), 50.0);      // behind the eye
    EXPECT_EQ(with_box(Vec3(0.0, -1001.0, 0.0), 2000.0), 50.0);  // below the bodies: a meter below the eye
    scene.camera.orbit = 10.0;
    EXPECT_EQ(with_box(Vec3(0.0, 0.0, 215.0), 10.0), 400.0);  // visible later
    scene.camera.orbit = 0.0;
    scene.bodies[3].keyframes = {{0.0, Vec3(0.0, 0.0, -1.0), Quat::Identity()},
                                 {1.0, Vec3(0.0, 0.0, -195.0), Quat::Identity()}};
    EXPECT_EQ(with_box(Vec3(0.0, 0.0, -1.0), 10.0), 400.0);  // visible at the end
    scene.bodies[3].keyframes.clear();
    scene.camera.keyframes = {{0.0, {0, 0, 10}, {0, 0, 0}, 40.0}, {1.0, {0, 0, 20}, {0, 0, 0}, 40.0}};
    EXPECT_EQ(with_box(Vec3(0.0, 0.0, -195.0), 10.0), 420.0);  // the farthest
}

TEST(FogDistance, ATowerBehindMarblesIsVisible) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.0, 0.2, 0.5);
    scene.camera.target = Vec3(0.0, 0.2, 0.0);
    scene.bodies.push_back(ground_plane({176, 180, 184}, Pattern::grid));
    scene.bodies.push_back(box_body(Vec3(0.0, 10.0, -60.0), Vec3(8.0, 20.0, 8.0), {200, 40, 30}));
    const Image alone = drawn(scene);
    for (const double x : {-0.1, 0.0, 0.1}) scene.bodies.push_back(ball_body(Vec3(x, 0.02, 0.0), 0.02, {90, 90, 90}));
    const Image image = drawn(scene);
    const Pixel at = pixel_of(scene, Vec3(0.0, 6.0, -56.0));
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(image.at(at.x, at.y)[channel], alone.at(at.x, at.y)[channel], 30) << "channel " << channel;
}

/// A shot by a camera at (x, 1, 8), to (x, 1, 0).
CameraShot shot_at(double x, double start, double end, double move = 0.0) {
    CameraShot shot;
    shot.start = start;
    shot.end = end;
    shot.move = move;
    shot.camera.eye = {x, 1.0, 8.0};
    shot.camera.target = {x, 1.0, 0.0};
    return shot;
}

/// The heap by a camera at (0, 1, 8), to (0, 1, 0), that stands still.
SceneDescription seen_from_the_front() {
    SceneDescription scene = small_heap();
    scene.camera = CameraDescription();
    scene.camera.eye = {0.0, 1.0, 8.0};
    scene.camera.target = {0.0, 1.0, 0.0};
    return scene;
}

TEST(Shots, CutAtTheirTimes) {
    SceneDescription scene = seen_from_the_front();
    scene.camera.shots = {shot_at(1.0, 1.0, 2.0), shot_at(2.0, 3.0, INFINITY)};
    const CameraAnimation animation(scene.camera);
    for (const auto& [time, x] :
         {std::pair{0.0, 0.0}, {0.999, 0.0}, {1.0, 1.0}, {1.999, 1.0}, {2.0, 0.0}, {3.0, 2.0}, {100.0, 2.0}})
        EXPECT_EQ(animation.at(at_time(scene, time)).eye.x(), x) << time;
    EXPECT_TRUE(scene.camera.moves());
}

TEST(Shots, MoveFromTheViewBefore) {
    SceneDescription scene = seen_from_the_front();
    scene.camera.shots = {shot_at(1.0, 1.0, 2.0, 0.5), shot_at(3.0, 2.0, INFINITY, 0.5)};
    scene.camera.shots[1].camera.vertical_fov = 60.0;
    const CameraAnimation animation(scene.camera);
    const auto x = [&](double time) { return animation.at(at_time(scene, time)).eye.x(); };
    EXPECT_EQ(x(1.0), 0.0);
    EXPECT_NEAR(x(1.25), 0.5, rounding);
    EXPECT_NEAR(x(1.125), 0.15625, rounding);  // 3 p^2 - 2 p^3 at a quarter
    EXPECT_EQ(x(1.5), 1.0);
    EXPECT_NEAR(x(2.25), 2.0, rounding);  // from the shot before
    EXPECT_NEAR(animation.at(at_time(scene, 2.25)).vertical_fov, 0.5 * (60.0 + scene.camera.vertical_fov), rounding);
}

TEST(Shots, FollowTheirOwnBodies) {
    SceneDescription scene = seen_from_the_front();
    scene.camera.shots = {shot_at(1.0, 1.0, INFINITY), shot_at(2.0, 2.0, INFINITY)};
    scene.camera.shots[0].camera.follow = 3;
    scene.camera.shots[1].camera.follow = 2;
    EXPECT_EQ(followed_bodies(scene.camera), (std::vector<std::size_t>{2, 3}));
    Snapshot snapshot = at_time(scene, 1.0);
    const CameraAnimation animation(scene.camera);
    const Vec3 before = animation.at(snapshot).eye;
    snapshot.bodies[3].center_of_mass += Vec3(1, 2, 3);
    snapshot.bodies[3].origin += Vec3(1, 2, 3);
    EXPECT_NEAR((animation.at(snapshot).eye - before - Vec3(1, 2, 3)).norm(), 0.0, rounding);
}

}  // namespace
}  // namespace tumble::camera_animation_test
