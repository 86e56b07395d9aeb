// Every key of the format, once, with a value that is not its default.
#include "scene/load.h"
#include "support/folder.h"
#include "support/tiny_png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tumble::scene_values_test {
namespace {

SceneDescription parse(const std::string& text) { return parse_scene(text, "scene.toml"); }

const char* const everything = R"(
format = 1
title = "Everything"
[simulation]
duration = 2          # whole numbers are numbers too
steps_per_frame = 8
gravity = [0.0, -1.62, 0.5]
integrator = "explicit-euler"
impacts = "stepped"
impact_law = "simultaneous"
rotation = "matrix"
sleep = false
seed = 42
[output]
size = [640, 360]
fps = 30
samples = 2
[camera]
eye = [1, 2, 3]
target = [4, 5, 6]
up = [0, 0, 2]
vertical_fov = 55.5
[light]
direction = [0, -2, 0]
shadows = false
[wind]
velocity = [3, 0, -1]
density = 1.1
drag = 0.8
[contact]
restitution_rule = "multiply"
friction_rule = "minimum"
[materials.steel]
color = "#8090A0"
density = 7800
restitution = 0.9
friction = 0.1
roughness = 0.2
metallic = 1
pattern = "checker"
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane", normal = [0, 3, 4], offset = 0.5 }
friction = 0.7
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.25 }
material = "steel"
mass = 3
restitution = 0.4
color = "#ff0080"
visible = false
position = [1, 2, 3]
rotation = { axis = [0, 0, 10], angle = 90 }
velocity = [4, 5, 6]
angular_velocity = [7, 8, 9]
[[body]]
shape = { type = "box", size = [1, 2, 3] }
material = "steel"
density = 500
roughness = 0.9
metallic = 0.25
pattern = "grid"
integrator = "symplectic-euler"
rotation = [0.7071, 0.7071, 0, 0]
[[body]]
name = "paddle"
type = "kinematic"
shape = { type = "box", size = [1, 1, 1] }
position = [0, 9, 0]
interpolation = "linear"
keyframes = [
  { time = 0.5, rotation = [0, 1, 0, 0] },
  { time = 1.5, position = [1, 0, 0] },
]
[[force]]
body = "ball"
point = [0, 0.25, 0]
force = [10, 0, 0]
frame = "body"
start = 0.5
end = 1.5
[[force]]
body = "2"
force = [0, 1, 0]
[[cord]]
body = "paddle"
point = [0, 0.5, 0]
anchor = [0, 5, 0]
radius = 0.02
color = "#010203"
)";

TEST(SceneValues, Settings) {
    const SceneDescription scene = parse(everything);
    EXPECT_EQ(scene.file, "scene.toml");
    EXPECT_EQ(scene.title, "Everything");
    EXPECT_EQ(scene.simulation.duration, 2.0);
    EXPECT_EQ(scene.simulation.steps_per_frame, 8);
    EXPECT_EQ(scene.simulation.gravity, Vec3(0, -1.62, 0.5));
    EXPECT_EQ(scene.simulation.integrator, IntegratorKind::explicit_euler);
    EXPECT_EQ(scene.simulation.impacts, ImpactMode::stepped);
    EXPECT_EQ(scene.simulation.impact_law, ImpactLaw::simultaneous);
    EXPECT_EQ(scene.simulation.rotation, RotationForm::matrix);
    EXPECT_FALSE(scene.simulation.sleep);
    EXPECT_EQ(scene.simulation.seed, 42u);
    EXPECT_EQ(scene.output.width, 640);
    EXPECT_EQ(scene.output.height, 360);
    EXPECT_EQ(scene.output.fps, 30.0);
    EXPECT_EQ(scene.output.samples, 2);
    EXPECT_EQ(scene.camera.eye, Vec3(1, 2, 3));
    EXPECT_EQ(scene.camera.target, Vec3(4, 5, 6));
    EXPECT_EQ(scene.camera.up, Vec3(0, 0, 1));
    EXPECT_EQ(scene.camera.vertical_fov, 55.5);
    EXPECT_EQ(scene.light.direction, Vec3(0, -1, 0));
    EXPECT_FALSE(scene.light.shadows);
    ASSERT_TRUE(scene.wind.has_value());
    EXPECT_EQ(scene.wind->velocity, Vec3(3, 0, -1));
    EXPECT_EQ(scene.wind->density, 1.1);
    EXPECT_EQ(scene.wind->drag, 0.8);
    EXPECT_EQ(scene.contact.restitution, PairRule::multiply);
    EXPECT_EQ(scene.contact.friction, PairRule::minimum);
    EXPECT_DOUBLE_EQ(scene.step(), 1.0 / 240.0);
}

TEST(SceneValues, BodiesTakeMissingKeysFromTheirMaterial) {
    const SceneDescription scene = parse(everything);
    ASSERT_EQ(scene.bodies.size(), 4u);

    const BodyDescription& ball = scene.bodies[1];
    EXPECT_EQ(ball.name, "ball");
    EXPECT_EQ(ball.type, BodyType::dynamic);
    EXPECT_EQ(std::get<SphereShape>(ball.shape).radius, 0.25);
    EXPECT_EQ(ball.mass, 3.0);
    EXPECT_EQ(ball.density, 7800.0);
    EXPECT_EQ(ball.restitution, 0.4);
    EXPECT_EQ(ball.friction, 0.1);
    EXPECT_EQ(ball.appearance.color, (Color{0xff, 0x00, 0x80}));
    EXPECT_EQ(ball.appearance.roughness, 0.2);
    EXPECT_EQ(ball.appearance.metallic, 1.0);
    EXPECT_EQ(ball.appearance.pattern, Pattern::checker);
    EXPECT_FALSE(ball.appearance.visible);
    EXPECT_EQ(ball.position, Vec3(1, 2, 3));
    EXPECT_EQ(ball.velocity, Vec3(4, 5, 6));
    EXPECT_EQ(ball.angular_velocity, Vec3(7, 8, 9));
    EXPECT_NEAR(ball.rotation.w(), std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(ball.rotation.z(), std::sqrt(0.5), 1e-15);

    const BodyDescription& box = scene.bodies[2];
    EXPECT_EQ(box.name, "2");  // the index in the file
    EXPECT_EQ(std::get<BoxShape>(box.shape).size, Vec3(1, 2, 3));
    EXPECT_EQ(box.density, 500.0);
    EXPECT_FALSE(box.mass.has_value());
    EXPECT_EQ(box.restitution, 0.9);
    EXPECT_EQ(box.appearance.color, (Color{0x80, 0x90, 0xa0}));
    EXPECT_EQ(box.appearance.roughness, 0.9);
    EXPECT_EQ(box.appearance.metallic, 0.25);
    EXPECT_EQ(box.appearance.pattern, Pattern::grid);
    EXPECT_EQ(box.integrator, IntegratorKind::symplectic_euler);
    EXPECT_FALSE(ball.integrator.has_value());     // the simulation's
    EXPECT_NEAR(box.rotation.norm(), 1.0, 1e-15);  // 0.7071 is close enough to be normalized
}

TEST(SceneValues, APlaneHasAUnitNormalAndItsOwnDefaults) {
    const BodyDescription floor = parse(everything).bodies[0];
    const auto& plane = std::get<PlaneShape>(floor.shape);
    EXPECT_TRUE(plane.normal.isApprox(Vec3(0, 0.6, 0.8), 1e-15));
    EXPECT_EQ(plane.offset, 0.5);
    EXPECT_EQ(floor.type, BodyType::fixed);
    EXPECT_EQ(floor.friction, 0.7);
    EXPECT_EQ(floor.restitution, std::nullopt);
    EXPECT_EQ(floor.restitution_in_pair(), value_of_other);
    EXPECT_EQ(floor.appearance.pattern, Pattern::grid);
    EXPECT_GT(int(floor.appearance.color.r), 0xc0);
}

TEST(SceneValues, KeyframesKeepMissingPartsOfThePose) {
    const BodyDescription paddle = parse(everything).bodies[3];
    EXPECT_EQ(paddle.type, BodyType::kinematic);
    EXPECT_EQ(paddle.interpolation, Interpolation::linear);
    ASSERT_EQ(paddle.keyframes.size(), 2u);
    EXPECT_EQ(paddle.keyframes[0].time, 0.5);
    EXPECT_EQ(paddle.keyframes[0].position, Vec3(0, 9, 0));
    EXPECT_EQ(paddle.keyframes[0].rotation.coeffs(), Quat(0, 1, 0, 0).coeffs());
    EXPECT_EQ(paddle.keyframes[1].position, Vec3(1, 0, 0));
    EXPECT_EQ(paddle.keyframes[1].rotation.coeffs(), Quat::Identity().coeffs());
    EXPECT_EQ(paddle.rotation.coeffs(), Quat(0, 1, 0, 0).coeffs());  // its pose is that of the first keyframe
}

TEST(SceneValues, ForcesAndCordsFindTheirBodies) {
    const SceneDescription scene = parse(everything);
    ASSERT_EQ(scene.forces.size(), 2u);
    EXPECT_EQ(scene.forces[0].body, 1u);
    EXPECT_EQ(scene.forces[0].point, Vec3(0, 0.25, 0));
    EXPECT_EQ(scene.forces[0].force, Vec3(10, 0, 0));
    EXPECT_TRUE(scene.forces[0].body_frame);
    EXPECT_EQ(scene.forces[0].start, 0.5);
    EXPECT_EQ(scene.forces[0].end, 1.5);
    EXPECT_EQ(scene.forces[1].body, 2u);  // by its index
    EXPECT_FALSE(scene.forces[1].body_frame);
    EXPECT_EQ(scene.forces[1].end, std::numeric_limits<double>::infinity());
    ASSERT_EQ(scene.cords.size(), 1u);
    EXPECT_EQ(scene.cords[0].body, 3u);
    EXPECT_EQ(scene.cords[0].anchor, Vec3(0, 5, 0));
    EXPECT_EQ(scene.cords[0].radius, 0.02);
    EXPECT_EQ(scene.cords[0].color, (Color{1, 2, 3}));
}

TEST(SceneValues, AnEmptySceneHasTheDefaultsOfTheFormat) {
    const SceneDescription scene = parse("format = 1");
    EXPECT_EQ(scene.simulation.duration, 5.0);
    EXPECT_EQ(scene.simulation.steps_per_frame, 16);
    EXPECT_EQ(scene.simulation.gravity, Vec3(0, -9.81, 0));
    EXPECT_EQ(scene.simulation.integrator, IntegratorKind::symplectic_euler);
    EXPECT_EQ(scene.simulation.impact_law, ImpactLaw::propagating);
    EXPECT_TRUE(scene.simulation.sleep);
    EXPECT_EQ(scene.output.width, 1280);
    EXPECT_EQ(scene.output.fps, 60.0);
    EXPECT_TRUE(scene.light.shadows);
    EXPECT_FALSE(scene.wind.has_value());
    EXPECT_EQ(scene.contact.restitution, PairRule::maximum);
    EXPECT_EQ(scene.contact.friction, PairRule::geometric);
    EXPECT_TRUE(scene.bodies.empty());
    EXPECT_EQ(scene.frame_count(), 301);
}

TEST(SceneValues, ABodyWithoutMaterialHasTheDefaultsOfTheFormat) {
    const BodyDescription body = parse("format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 1 }").bodies[0];
    EXPECT_EQ(body.density, 1000.0);
    EXPECT_EQ(body.restitution_in_pair(), 0.5);
    EXPECT_EQ(body.friction_in_pair(), 0.0);
    EXPECT_EQ(body.name, "0");
    EXPECT_EQ(body.appearance.pattern, Pattern::panel);
    EXPECT_TRUE(body.appearance.visible);
    EXPECT_EQ(body.position, Vec3(0, 0, 0));
    EXPECT_EQ(body.rotation.coeffs(), Quat::Identity().coeffs());
}

TEST(SceneValues, APlainBoxIsNotTheBoxWithoutAPattern) {
    const auto pattern_of = [](const std::string& lines) {
        return parse("format = 1\n[[body]]\ntype = \"fixed\"\n" + lines).bodies[0].appearance.pattern;
    };
    const std::string box = "shape = { type = \"box\", size = [1, 1, 1] }\n", plane = "shape = { type = \"plane\" }\n";
    EXPECT_EQ(pattern_of(box), Pattern::panel);
    EXPECT_EQ(pattern_of(box + "pattern = \"panel\""), Pattern::panel);
    EXPECT_EQ(pattern_of(box + "pattern = \"plain\""), Pattern::plain);
    EXPECT_EQ(pattern_of(plane + "pattern = \"plain\""), Pattern::panel);  // one look, one hash
    EXPECT_EQ(pattern_of(plane), Pattern::grid);
}

TEST(SceneValues, TheTextureOfABodyTakesThePlaceOfThePatternOfItsMaterial) {
    const std::string text = R"(
format = 1
[materials.stone]
pattern = "marble"
color = "#808080"
[materials.boxed]
texture = "image.png"
texture_scale = 0.5
[[body]]
material = "stone"
texture = "image.png"
texture_filter = "nearest"
shape = { type = "box", size = [1, 1, 1] }
[[body]]
material = "boxed"
pattern = "wood"
pattern_color = "#402010"
pattern_scale = 0.2
shape = { type = "sphere", radius = 1 }
[[body]]
material = "boxed"
shape = { type = "sphere", radius = 1 }
)";
    const TestFolder folder;
    write_text(folder / "image.png", tiny_png());
    const SceneDescription scene = parse_scene(text, folder / "scene.toml");
    const Appearance& box = scene.bodies[0].appearance;
    ASSERT_TRUE(box.texture);
    EXPECT_EQ(box.texture->levels.front().width, 2);
    EXPECT_EQ(box.pattern, Pattern::plain);
    EXPECT_EQ(box.color, (Color{0x80, 0x80, 0x80}));
    EXPECT_EQ(box.texture_scale, 0.0);
    EXPECT_EQ(box.texture_filter, TextureFilter::nearest);
    const Appearance& ball = scene.bodies[1].appearance;
    EXPECT_FALSE(ball.texture);
    EXPECT_EQ(ball.pattern, Pattern::wood);
    EXPECT_EQ(ball.pattern_color, (Color{0x40, 0x20, 0x10}));
    EXPECT_EQ(ball.pattern_scale, 0.2);
    const Appearance& other = scene.bodies[2].appearance;
    EXPECT_EQ(other.texture, box.texture);  // read once
    EXPECT_EQ(other.color, (Color{255, 255, 255}));
    EXPECT_EQ(other.texture_scale, 0.5);
}

TEST(SceneValues, AStepThatDividesTheFrameBecomesItsNumberOfSteps) {
    EXPECT_EQ(parse("format = 1\n[simulation]\nstep = 0.0005\n[output]\nfps = 50").simulation.steps_per_frame, 40);
    EXPECT_EQ(parse("format = 1\n[simulation]\nstep = 0.016666667").simulation.steps_per_frame, 1);  // within 1e-9 s
    EXPECT_EQ(parse("format = 1\n[simulation]\nstep = 1e-6\n[output]\nfps = 1e6").simulation.steps_per_frame, 1);
}

TEST(SceneValues, AFractionIsAFrameRate) {
    const SceneDescription film =
        parse("format = 1\n[simulation]\nduration = 10.01\nsteps_per_frame = 4\n[output]\nfps = \"24000/1001\"");
    EXPECT_EQ(film.output.fps, 24000.0 / 1001.0);
    EXPECT_EQ(film.frame_count(), 241);  // the last one at 240 * 1001 / 24000 = 10.01 s
    EXPECT_EQ(film.step(), 1.0 / (24000.0 / 1001.0 * 4));
    EXPECT_EQ(parse("format = 1\n[output]\nfps = \"60/1\"").output.fps, 60.0);
    EXPECT_EQ(parse("format = 1\n[simulation]\nstep = 0.0033366666666666667\n[output]\nfps = \"30000/1001\"")
                  .simulation.steps_per_frame,
              10);
}

TEST(SceneValues, AMovingCamera) {
    const auto camera = parse(R"(
format = 1
[camera]
eye = [1, 2, 3]
target = [0, 1, 0]
vertical_fov = 50
orbit = -36
follow = "ball"
interpolation = "linear"
keyframes = [{ time = 1 }, { time = 2.5, eye = [4, 5, 6], vertical_fov = 20 }, { time = 3, target = [0, 0, 1] }]
[[body]]
shape = { type = "plane" }
type = "fixed"
[[body]]
name = "ball"
shape = { type = "sphere", radius = 1 }
position = [7, 8, 9]
)")
                            .camera;
    EXPECT_TRUE(camera.moves());
    EXPECT_EQ(camera.orbit, -36.0);
    EXPECT_EQ(camera.follow, 1u);
    EXPECT_EQ(camera.follow_start, Vec3(7, 8, 9));
    EXPECT_EQ(camera.interpolation, Interpolation::linear);
    ASSERT_EQ(camera.keyframes.size(), 3u);
    EXPECT_EQ(camera.keyframes[0].time, 1.0);
    EXPECT_EQ(camera.keyframes[0].eye, Vec3(1, 2, 3));
    EXPECT_EQ(camera.keyframes[1].eye, Vec3(4, 5, 6));
    EXPECT_EQ(camera.keyframes[1].target, Vec3(0, 1, 0));
    EXPECT_EQ(camera.keyframes[1].vertical_fov, 20.0);
    EXPECT_EQ(camera.keyframes[2].target, Vec3(0, 0, 1));
    EXPECT_EQ(camera.keyframes[2].vertical_fov, 50.0);
}

TEST(SceneValues, ACameraThatFollowsLooksAtItsBody) {
    const std::string scene =
        "format = 1\n[[body]]\nname = \"ball\"\nshape = { type = \"sphere\", radius = 1 }\nposition = [7, 8, "
        "9]\n[camera]\n";
    EXPECT_FALSE(parse(scene).camera.moves());
    EXPECT_EQ(parse(scene + "follow = \"ball\"").camera.target, Vec3(7, 8, 9));
    EXPECT_EQ(parse(scene + "follow = \"ball\"\ntarget = [1, 1, 1]").camera.target, Vec3(1, 1, 1));
}

TEST(SceneValues, FrameCount) {
    const auto frames = [](double duration, double fps) {
        SceneDescription scene;
        scene.simulation.duration = duration;
        scene.output.fps = fps;
        return scene.frame_count();
    };
    EXPECT_EQ(frames(0.0, 60.0), 1);
    EXPECT_EQ(frames(5.0, 60.0), 301);
    EXPECT_EQ(frames(4.35, 100.0), 436);  // 434.99999999999994 means 435
    EXPECT_EQ(frames(0.999, 60.0), 60);   // 59.94: the last frame is before the end
    EXPECT_EQ(frames(1.0, 29.97), 30);
    EXPECT_EQ(frames(1.0, 1e6), 1000001);
    EXPECT_EQ(frames(100.0, 1e-3), 1);
    for (int n = 0; n < 3000; ++n) EXPECT_EQ(frames(n / 30.0, 30.0), n + 1) << n;
}

TEST(SceneValues, WholeTurnsAreNoRotation) {
    for (const char* angle : {"0", "360", "720", "-1440", "720000"}) {
        const auto body = parse(std::string("format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 1 }\n"
                                            "rotation = { axis = [1, 1, 0], angle = ") +
                                angle + " }")
                              .bodies[0];
        EXPECT_EQ(body.rotation.coeffs(), Quat::Identity().coeffs()) << angle;
    }
}

}  // namespace
}  // namespace tumble::scene_values_test
