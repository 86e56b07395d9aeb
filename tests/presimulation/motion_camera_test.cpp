// The default camera by the motion: each scene's subject, as it moves, fills a good part of the frame and stays in it.
#include "presimulation/motion_camera.h"
#include "render/camera/camera.h"
#include "scene/load.h"
#include "sim/geometry/shapes/shape.h"
#include "sim/world.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tumble::motion_camera_test {
namespace {

SceneDescription scene_of(const std::string& text) { return parse_scene("format = 1\n" + text, "scene.toml"); }

const std::string ground = "[[body]]\ntype = \"fixed\"\nshape = { type = \"plane\" }\n";

/// Part of the frame's width and height that moving bodies cover over the whole clip, and the part of their corners
/// that is inside of the frame.
struct Cover {
    double width = 0.0, height = 0.0, inside = 0.0;
};

Cover cover_of(const SceneDescription& scene, const CameraDescription& description) {
    const int w = scene.output.width, h = scene.output.height;
    const Camera camera(description, w, h);
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    int corners = 0, inside = 0;
    World world(scene);
    for (std::int64_t n = 0; n < scene.frame_count(); ++n) {
        if (n > 0) world.advance_frame();
        const Snapshot now = world.snapshot();
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
            if (scene.bodies[i].type == BodyType::fixed) continue;
            const Bounds bounds = local_bounds(scene.bodies[i].shape);
            for (int k = 0; k < 8; ++k) {
                const Vec3 corner(k & 1 ? bounds.max.x() : bounds.min.x(), k & 2 ? bounds.max.y() : bounds.min.y(),
                                  k & 4 ? bounds.max.z() : bounds.min.z());
                const Vec3 place = now.bodies[i].origin + now.bodies[i].orientation * corner;
                const Vec3 relative = camera.relative(place);
                ++corners;
                if (relative.dot(camera.forward()) <= 0.0) continue;
                const Eigen::Vector2d pixel = camera.pixel(relative);
                if (pixel.x() < 0.0 || pixel.x() > w || pixel.y() < 0.0 || pixel.y() > h) continue;
                ++inside;
                left = std::min(left, pixel.x()), right = std::max(right, pixel.x());
                top = std::min(top, pixel.y()), bottom = std::max(bottom, pixel.y());
            }
        }
    }
    return {(right - left) / w, (bottom - top) / h, double(inside) / corners};
}

void expect_framed(const SceneDescription& scene, double least_inside = 1.0) {
    const Cover cover = cover_of(scene, simulated_motion(scene, 1).camera());
    const std::string text = fmt::format("{:.2f} x {:.2f}, {:.4f} inside", cover.width, cover.height, cover.inside);
    EXPECT_GE(std::max(cover.width, cover.height), 0.3) << text;
    EXPECT_LE(std::max(cover.width, cover.height), least_inside < 1.0 ? 1.0 : 0.82) << text;
    EXPECT_GE(cover.inside, least_inside) << text;
}

TEST(MotionCamera, FramesABallThatIsThrownAtAWall) {
    expect_framed(scene_of("[simulation]\nduration = 5\n" + ground + R"(
[[body]]
type = "fixed"
shape = { type = "box", size = [0.2, 2, 3] }
position = [2, 1, 0]
[[body]]
shape = { type = "sphere", radius = 0.2 }
position = [-1, 0.6, 0]
velocity = [10, 2, 0]
restitution = 0.3
friction = 0.5
)"),
                  0.5);
}

TEST(MotionCamera, FramesABoxThatSlides) {
    expect_framed(scene_of("[simulation]\nduration = 2\n" + ground + R"(
[[body]]
shape = { type = "box", size = [0.4, 0.4, 0.4] }
position = [0, 0.2, 0]
velocity = [0, 0, 4]
friction = 0.4
)"));
}

TEST(MotionCamera, FramesARowOfDominoes) {
    std::string text = "[simulation]\nduration = 3\n" + ground;
    for (int i = 0; i < 15; ++i)
        text += fmt::format(
            "[[body]]\nshape = {{ type = \"box\", size = [0.1, 1, 0.5] }}\nposition = [{}, 0.5, 0]\n"
            "angular_velocity = [0, 0, {}]\n",
            0.45 * i, i == 0 ? -2.0 : 0.0);
    expect_framed(scene_of(text));
}

TEST(MotionCamera, FramesBallsOnATable) {
    std::string text = "[simulation]\nduration = 2\n" + ground;
    for (int i = 0; i < 15; ++i)
        text += fmt::format("[[body]]\nshape = {{ type = \"sphere\", radius = 0.03 }}\nposition = [{}, 0.03, {}]\n",
                            0.062 * (i % 5), 0.062 * (i / 5));
    text +=
        "[[body]]\nshape = { type = \"sphere\", radius = 0.03 }\nposition = [-0.8, 0.03, 0.05]\nvelocity = [1.5, 0, "
        "0]\n";
    const SceneDescription scene = scene_of(text);
    expect_framed(scene);
    const CameraDescription camera = simulated_motion(scene, 1).camera();
    const Vec3 view = (camera.eye - camera.target).normalized();
    EXPECT_GT(view.y(), 0.5) << "balls that spread over the table are seen from above";
}

// The box is pushed aside at first; then the ball falls off the edge, and farther than the clip shows.
TEST(MotionCamera, LetsABodyGoThatFallsOffTheTable) {
    const std::string text = R"(
[simulation]
duration = 20
[[body]]
type = "fixed"
shape = { type = "box", size = [1, 0.1, 1] }
[[body]]
shape = { type = "box", size = [0.2, 0.2, 0.2] }
position = [0.2, 0.15, 0]
friction = 0.5
velocity = [-1, 0, 0]
[[body]]
shape = { type = "sphere", radius = 0.1 }
position = [0.2, 0.15, 0.3]
velocity = [1, 0, 0]
)";
    const CameraDescription camera = simulated_motion(scene_of(text), 1).camera();
    EXPECT_LT((camera.eye - camera.target).norm(), 4.0);
}

TEST(MotionCamera, LeavesOutTheFewOfACrowdThatFlyFar) {
    std::string text = "[simulation]\nduration = 1\n" + ground;
    for (int i = 0; i < 100; ++i)
        text += fmt::format(
            "[[body]]\nshape = {{ type = \"box\", size = [0.1, 0.1, 0.1] }}\nposition = [{}, {}, 0]\n"
            "velocity = [0, 0, {}]\n",
            0.2 * (i % 10), 0.3 + 0.2 * (i / 10), i == 50 ? -30.0 : 0.0);
    const SceneDescription scene = scene_of(text);
    const CameraDescription camera = simulated_motion(scene, 1).camera();
    EXPECT_LT((camera.eye - camera.target).norm(), 8.0);
    expect_framed(scene, 0.95);
}

TEST(MotionCamera, LooksFromTheSideOfTheMotion) {
    const auto eye_of = [](const char* velocity) {
        const SceneDescription scene = scene_of(
            "[simulation]\nduration = 1\ngravity = [0, 0, 0]\n[[body]]\nshape = { type = \"sphere\", radius = "
            "0.2 }\nvelocity = " +
            std::string(velocity) + "\n");
        const CameraDescription camera = simulated_motion(scene, 1).camera();
        return Vec3((camera.eye - camera.target).normalized());
    };
    EXPECT_LT(std::fabs(eye_of("[3, 0, 0]").x()), 0.6);
    EXPECT_LT(std::fabs(eye_of("[0, 0, 3]").z()), 0.6);
}

TEST(MotionCamera, ShowsBodiesThatStandStill) {
    const SceneDescription scene = scene_of("[simulation]\nduration = 1\n" + ground + R"(
[[body]]
shape = { type = "box", size = [1, 1, 1] }
position = [0, 0.5, 0]
)");
    expect_framed(scene);
}

TEST(MotionCamera, KeepsAnEyeAndATargetOfItsOwn) {
    const std::string body = R"(
[[body]]
shape = { type = "sphere", radius = 0.2 }
velocity = [3, 0, 0]
)";
    const auto camera_of = [&](const std::string& camera) {
        return framed(scene_of("[simulation]\nduration = 1\n[camera]\n" + camera + body), 1).camera;
    };
    EXPECT_EQ(camera_of("eye = [0, 1, 9]").eye, Vec3(0, 1, 9));
    EXPECT_EQ(camera_of("target = [7, 0, 0]").target, Vec3(7, 0, 0));
    EXPECT_EQ(camera_of("eye = [0, 1, 9]\ntarget = [1, 0, 0]").target, Vec3(1, 0, 0));
    const CameraDescription moved = camera_of("vertical_fov = 40"), start = camera_of("fit = \"start\"");
    EXPECT_NE(moved.eye, start.eye);
}

// The picture of a frame is the same in a clip that ends earlier or later than the scene's file says.
TEST(MotionCamera, DoesNotDependOnTheDurationOfTheClip) {
    const std::string text = "[simulation]\nduration = 1\n[[body]]\nshape = { type = \"sphere\", radius = 0.2 }\n";
    SceneOverrides overrides;
    const auto eye_for = [&](double duration) {
        overrides.duration = duration;
        return framed(parse_scene("format = 1\n" + text, "scene.toml", overrides), 1).camera.eye;
    };
    EXPECT_EQ(eye_for(0.25), eye_for(1.0));
    EXPECT_EQ(eye_for(3.0), eye_for(1.0));
}

// A simulation that fails is framed until then.
TEST(MotionCamera, FramesARunThatFails) {
    const SceneDescription scene = scene_of(R"(
[simulation]
duration = 1
[[body]]
shape = { type = "sphere", radius = 0.2 }
[[force]]
body = "0"
force = [1e15, 0, 0]
start = 0.5
)");
    EXPECT_TRUE(simulated_motion(scene, 1).camera().eye.allFinite());
}

}  // namespace
}  // namespace tumble::motion_camera_test
