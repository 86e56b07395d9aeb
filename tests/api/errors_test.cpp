// Each mistake is an Error with its kind and its place.
#include "scenes.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace tumble {
namespace {

Error error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "nothing was thrown";
    return Error(ErrorKind::run, {}, "nothing was thrown");
}

/// The element that is blamed after the change.
std::string blamed(const std::function<void(SceneSpec&)>& change) {
    SceneSpec spec = crate_and_ball();
    change(spec);
    const Error error = error_of([&] { Scene scene(spec); });
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.what(), error.where().element + ": error: " + error.message());
    EXPECT_TRUE(error.where().file.empty());
    return error.where().element;
}

TEST(Errors, OfASceneFileHaveFileLineAndColumn) {
    const TestFolder folder;
    const std::string file = folder / "wrong.toml";
    write_text(file, "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = -1 }\n");
    const Error error = error_of([&] { load_scene(file); });
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.where().file, file);
    EXPECT_EQ(error.where().line, 3);
    EXPECT_EQ(error.where().column, 37);
    EXPECT_TRUE(error.where().element.empty());
    EXPECT_EQ(error.what(), file + ":3:37: error: " + error.message());
    EXPECT_NE(error.message().find("radius must be from"), std::string::npos) << error.message();
}

TEST(Errors, OfAMissingSceneFileNameIt) {
    const Error error = error_of([] { load_scene("/nowhere/scene.toml"); });
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.where().file, "/nowhere/scene.toml");
    EXPECT_EQ(error.where().line, 0);
}

TEST(Errors, OfASpecNameTheElement) {
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[2].shape = Sphere{-1.0}; }), "bodies[2].shape.radius");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].shape = Box{{1.0, 0.0, 1.0}}; }), "bodies[1].shape.size");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].position.x = NAN; }), "bodies[1].position");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].mass = 0.0; }), "bodies[1].mass");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].rotation = Quat{1.0, 1.0, 0.0, 0.0}; }), "bodies[1].rotation");
    EXPECT_EQ(blamed([](SceneSpec& s) {
                  s.bodies[1].rotation = AxisAngle{{0.0, 0.0, 0.0}, 10.0};
              }),
              "bodies[1].rotation");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[2].material.friction = -0.5; }), "bodies[2].material.friction");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[2].name = s.bodies[1].name; }), "bodies[2].name");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[0].velocity = {1.0, 0.0, 0.0}; }), "bodies[0].velocity");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[0].type = BodyType::dynamic; }), "bodies[0].shape");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].shape = Compound{}; }), "bodies[1].shape.parts");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].shape = Mesh{"nowhere.obj"}; }), "bodies[1].shape.file");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].name = std::string(1, char(0xff)); }), "bodies[1].name");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.simulation.duration = -1.0; }), "simulation.duration");
    const auto blamed_joint = [](const std::function<void(Joint&)>& change) {
        return blamed([&](SceneSpec& s) {
            Joint& joint = s.add_joint(JointType::hinge, "world", "crate");
            joint.anchor = Vec3{};
            joint.axis = Vec3{0.0, 1.0, 0.0};
            change(joint);
        });
    };
    EXPECT_EQ(blamed_joint([](Joint& j) { j.bodies[1] = "nobody"; }), "joints[0].bodies");
    EXPECT_EQ(blamed_joint([](Joint& j) { j.axis = Vec3{}; }), "joints[0].axis");
    EXPECT_EQ(blamed_joint([](Joint& j) { j.swing = {10.0, 10.0}; }), "joints[0].swing");
    EXPECT_EQ(blamed_joint([](Joint& j) { j.start = -1.0; }), "joints[0].start");
    EXPECT_EQ(blamed_joint([](Joint& j) { j.end = -1.0; }), "joints[0].end");
    EXPECT_EQ(blamed_joint([](Joint& j) {
                  j.motor = JointMotor{};
                  j.motor->stiffness = 1.0;
                  j.motor->keyframes = {{0.0, 1.0}, {0.0, 2.0}};
              }),
              "joints[0].motor.keyframes[1].time");
    EXPECT_EQ(blamed_joint([](Joint& j) { j.type = JointType::gear; }), "joints[0].bodies");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.simulation.step = 0.03; }), "simulation.step");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.simulation.seed = ~std::uint64_t(0); }), "simulation.seed");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.output.width = 0; }), "output.width");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.output.height = -1; }), "output.height");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.output.samples = 3; }), "output.samples");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.camera.follow = "nobody"; }), "camera.follow");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.light.direction = {}; }), "light.direction");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.wind = Wind{{}, -1.0, 1.0}; }), "wind.density");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.forces.push_back({"7", {}, {}}); }), "forces[0].body");
    EXPECT_EQ(blamed([](SceneSpec& s) {
                  s.bodies[1].grid = Grid{{1, 0, 1}, {1.0, 1.0, 1.0}, {}, 0.0};
              }),
              "bodies[1].grid.count");
    EXPECT_EQ(blamed([](SceneSpec& s) {
                  s.bodies[1].grid = Grid{};
                  s.bodies[1].scatter = Scatter{};
              }),
              "bodies[1].scatter");
    EXPECT_EQ(blamed([](SceneSpec& s) {
                  s.bodies[1].scatter = Scatter{50, {1.0, 1.0, 1.0}, true, 0.0};
              }),
              "bodies[1].scatter");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].scale = ScaleRange{1.0, 2.0}; }), "bodies[1].scale");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.bodies[1].colors = {Color{}}; }), "bodies[1].colors");
    EXPECT_EQ(blamed([](SceneSpec& s) { s.cords.push_back({"crate", {}, {}, 0.0}); }), "cords[0].radius");
    EXPECT_EQ(blamed([](SceneSpec& s) {
                  s.add(Box{}, BodyType::kinematic).keyframes = {{1.0, {}, {}}, {0.5, {}, {}}};
              }),
              "bodies[3].keyframes[1].time");
    EXPECT_EQ(blamed([](SceneSpec& s) {
                  s.bodies[1].shape = Compound{{{Box{}, {}, {}, {}, {}}, {Sphere{0.0}, {}, {}, {}, {}}}};
              }),
              "bodies[1].shape.parts[1].shape.radius");
}

TEST(Errors, OfAMeshFromMemoryNameItsFault) {
    const std::vector<Vec3> corners{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, NAN}};
    const auto message = [](const TriangleMesh& mesh, BodyType type) {
        SceneSpec spec;
        spec.add(mesh, type);
        const Error error = error_of([&] { Scene scene(spec); });
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_EQ(error.where().element, "bodies[0].shape.arrays");
        return error.message();
    };
    const std::vector<Triangle> one{{0, 1, 2}}, wrong{{0, 1, 2}, {0, 1, 9}};
    const std::vector<Vec3> three(corners.begin(), corners.begin() + 3);
    EXPECT_EQ(message({}, BodyType::fixed), "the mesh has no arrays");
    EXPECT_EQ(message({three, {}}, BodyType::fixed), "the mesh has no triangles");
    EXPECT_EQ(message({corners, one}, BodyType::fixed),
              "the mesh holds a coordinate that is not a finite number, or beyond 1e30");
    EXPECT_EQ(message({three, wrong}, BodyType::fixed),
              "the mesh has a wrong triangle, 1: a vertex must be below 3 (given 9)");
}

TEST(Errors, OfAClipTimingNameTheField) {
    const Scene scene(crate_and_ball());
    const auto blamed_field = [&](const ClipTiming& timing) {
        return error_of([&] { FrameSequence frames(scene, timing); }).where().element;
    };
    EXPECT_EQ(blamed_field({0.0, 0.0, 8}), "speed");
    EXPECT_EQ(blamed_field({NAN, 0.0, 8}), "speed");
    EXPECT_EQ(blamed_field({1.0, 400.0, 8}), "shutter");
    EXPECT_EQ(blamed_field({1.0, 180.0, 65}), "blur_samples");
}

TEST(Errors, OfAnEnumWithoutThatValueAreInput) {
    SceneSpec spec = crate_and_ball();
    spec.simulation.integrator = static_cast<Integrator>(99);
    EXPECT_EQ(error_of([&] { Scene scene(spec); }).kind(), ErrorKind::input);
    EXPECT_EQ(error_of([&] { to_toml(spec); }).kind(), ErrorKind::input);
}

TEST(Errors, OfLoadOptionsNameTheField) {
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, "format = 1\n");
    LoadOptions options;
    options.fps = -1.0;
    const Error error = error_of([&] { load_scene(file, options); });
    EXPECT_EQ(error.where().element, "fps");
    EXPECT_EQ(error.message().rfind("must be", 0), 0u) << error.message();
    options = {};
    options.steps_per_frame = 0;
    EXPECT_EQ(error_of([&] { load_scene(file, options); }).where().element, "steps_per_frame");
    options = {};
    options.height = 0;
    EXPECT_EQ(error_of([&] { load_scene(file, options); }).where().element, "height");
    options.width = 1 << 20;
    EXPECT_EQ(error_of([&] { load_scene(file, options); }).where().element, "width");
}

TEST(Errors, OfArgumentsAreInput) {
    const Scene scene(crate_and_ball());
    World world(scene);
    Snapshot few = world.snapshot();
    few.bodies.pop_back();
    const TestFolder folder;
    Renderer renderer(scene);
    AovRenderer aovs(scene, {true, false, false, true, false});
    TrajectoryTable table(folder / "t.csv", scene);
    ClipWriter clip(folder / "c.mp4", scene.output());
    const std::vector<std::function<void()>> mistakes = {
        [&] { World none(scene, 0); },
        [&] { world.properties(3); },
        [&] { scene.body_name(3); },
        [&] { scene.body_type(3); },
        [&] { renderer.render(few); },
        [&] { renderer.skip(few); },
        [&] { aovs.render(few, few); },
        [&] { aovs.render(world.snapshot()); },
        [&] { table.add(few); },
        [&] { write_png(folder / "a.png", {}); },
        [&] {
            write_png(folder / "a.png", {2, 2, {1, 2, 3}});
        },
        [&] { read_png(folder / "none.png"); },
        [&] {
            compare_images({1, 1, {0, 0, 0, 0}}, {1, 2, {0, 0, 0, 0, 0, 0, 0, 0}});
        },
        [&] { ClipWriter other(folder / "c.avi", scene.output()); },
        [&] {
            ClipWriter other(folder / "d.mp4", {0, 1, 1.0, 1});
        },
        [&] {
            ClipWriter other(folder / "d.mp4", {1, 1, NAN, 1});
        },
        [&] {
            clip.write({1, 1, {0, 0, 0, 0}});
        },
        [&] { clip.finish(); },
    };
    for (std::size_t i = 0; i < mistakes.size(); ++i) {
        const Error error = error_of(mistakes[i]);
        EXPECT_EQ(error.kind(), ErrorKind::input) << i << ": " << error.what();
        EXPECT_EQ(error.where().element, "");
    }
}

TEST(Errors, OfTheEnvironmentAreOfTheRun) {
    const Scene scene(crate_and_ball());
    const Image image{1, 1, {0, 0, 0, 255}};
    EXPECT_EQ(error_of([&] { write_png("/nowhere/a.png", image); }).kind(), ErrorKind::run);
    EXPECT_EQ(error_of([&] { EnergyTable table("/nowhere/e.csv"); }).kind(), ErrorKind::run);
    RenderOptions options;
    options.shader_folder = "/nowhere";
    EXPECT_EQ(error_of([&] { Renderer renderer(scene, options); }).kind(), ErrorKind::run);
}

TEST(Errors, CannotControlATerminal) {
    const Error error = error_of([] { load_scene("\x1b[2J.toml"); });
    EXPECT_EQ(std::string(error.what()).find('\x1b'), std::string::npos) << error.what();
}

}  // namespace
}  // namespace tumble
