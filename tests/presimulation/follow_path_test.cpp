// Cameras that come up with a body: the closed form of the critically damped answer, and the same path from any part.
#include "presimulation/follow_path.h"
#include "presimulation/motion_camera.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tumble::follow_path_test {
namespace {

SceneDescription scene_of(const std::string& keys) {
    return parse_scene(
        "format = 1\n[simulation]\nduration = 4\ngravity = [0, 0, 0]\n[[body]]\nname = \"ball\"\n"
        "shape = { type = \"sphere\", radius = 0.2 }\nvelocity = [3, 0, 0]\n[camera]\n"
        "follow = \"ball\"\neye = [0, 1, 5]\ntarget = [0, 0, 0]\nfollow_time = 0.4\n" +
            keys,
        "scene.toml");
}

// From rest behind a body of speed u, with w = 2 / T: y = u t - (2 u / w) + (2 u / w + u t) exp(-w t).
TEST(FollowPath, IsTheCriticallyDampedAnswer) {
    const SceneDescription scene = scene_of("");
    const CameraDescription camera = framed(scene, 1).camera;
    // One more than frames: the camera goes on while the shutter of the last frame is open.
    ASSERT_EQ(camera.keyframes.size(), std::size_t(scene.frame_count()) + 1);
    EXPECT_FALSE(camera.follow);
    const double u = 3.0, lag = u * 0.4, w = 2.0 / 0.4;
    for (const CameraKeyframe& key : camera.keyframes) {
        const double t = key.time, way = u * t - lag + (lag + u * t) * std::exp(-w * t);
        EXPECT_NEAR(key.eye.x(), way, 1e-9) << t;
        EXPECT_NEAR((key.eye - key.target - Vec3(0.0, 1.0, 5.0)).norm(), 0.0, 1e-12);
    }
    EXPECT_NEAR(u * camera.keyframes.back().time - camera.keyframes.back().eye.x(), lag, 1e-6);
}

TEST(FollowPath, StopsWithABodyAtRest) {
    FollowPath path(scene_of("").camera);
    Snapshot snapshot;
    snapshot.bodies.resize(1);
    snapshot.bodies[0].orientation = Quat::Identity();
    for (int n = 0; n <= 600; ++n) {
        snapshot.time = n / 60.0;
        snapshot.bodies[0].origin = snapshot.bodies[0].center_of_mass = Vec3(std::min(1.0, snapshot.time), 0.0, 0.0);
        path.see(snapshot);
        path.see(snapshot);  // a frame that stands still
    }
    const CameraDescription camera = path.applied(scene_of("").camera);
    ASSERT_EQ(camera.keyframes.size(), 601u);
    EXPECT_EQ(camera.keyframes[599].eye, camera.keyframes[600].eye);  // no frame is drawn anew for it
    EXPECT_NEAR(camera.keyframes[600].eye.x(), 1.0, 1e-12);
}

TEST(FollowPath, KeepsTheCamerasOwnKeyframesAndTheOtherCameras) {
    const SceneDescription scene = scene_of(
        "keyframes = [{ time = 0 }, { time = 2, eye = [0, 1, 3] }]\ninterpolation = "
        "\"linear\"\n[cameras.rigid]\nfollow = "
        "\"ball\"\n[[shot]]\ncamera = \"rigid\"\nfrom = 3\n");
    const CameraDescription camera = framed(scene, 1).camera;
    EXPECT_TRUE(camera.shots.front().camera.follow);
    EXPECT_TRUE(camera.shots.front().camera.keyframes.empty());
    for (const CameraKeyframe& key : camera.keyframes)
        EXPECT_NEAR((key.eye - key.target).z(), std::max(3.0, 5.0 - key.time), 1e-12) << key.time;
}

}  // namespace
}  // namespace tumble::follow_path_test
