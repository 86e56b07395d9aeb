// A scene that is built in code is the scene of the file with the same values.
#include "scenes.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace tumble {
namespace {

/// Every table and every shape of the format.
SceneSpec everything() {
    SceneSpec spec = crate_and_ball();
    spec.title = "All \"tables\"\n";
    spec.folder = TUMBLE_SOURCE_DIR "/assets/meshes";
    spec.simulation.step = 1.0 / 80.0;
    spec.simulation.gravity = {0.1, -9.7, -1e-300};
    spec.simulation.integrator = Integrator::splitting;
    spec.simulation.impact_law = ImpactLaw::simultaneous;
    spec.simulation.sleep = false;
    spec.camera.eye = Vec3{2.0, 3.0, 12.0};
    spec.camera.keyframes = {{0.0, {}, {}, {}}, {1.0, Vec3{3.0, 3.0, 9.0}, Vec3{0.0, 1.0, 0.0}, 30.0}};
    spec.camera.interpolation = Interpolation::linear;
    spec.camera.orbit = 12.0;
    spec.camera.follow = "crate";
    spec.light = {{0.1, -1.0, 0.2}, false};
    spec.wind = Wind{{3.0, 0.0, 1.0}, 1.3, 0.9};
    spec.bodies[0].material.friction = 0.4;
    spec.bodies[0].material.pattern = Pattern::checker;
    spec.bodies[1].material = {Color{1, 2, 254}, 600.0, 0.3, 0.2, 0.1, 1.0, Pattern::grid};
    spec.bodies[1].mass = 12.5;
    spec.bodies[1].rotation = AxisAngle{{1.0, 2.0, 3.0}, 40.0};
    spec.bodies[2].rotation = Quat{0.8, 0.6, 0.0, 0.0};
    spec.bodies[2].velocity = {-1.0 / 3.0, 0.0, 0.0};
    spec.bodies[2].integrator = Integrator::rk4;
    spec.bodies[2].visible = false;
    spec.add(Mesh{"torus.obj", 0.5, false}).position = {-3.0, 4.0, 0.0};
    spec.add(Mesh{"hoop.obj", 1.0, true}).position = {-3.0, 7.0, 0.0};
    CompoundPart leg{Box{{0.2, 1.0, 0.2}}, {0.0, -0.5, 0.0}, {}, 700.0, Color{9, 9, 9}};
    CompoundPart knob{Compound{{leg}}, {0.5, 0.0, 0.0}, AxisAngle{{0.0, 0.0, 1.0}, 90.0}, {}, {}};
    spec.add(Compound{{{Sphere{0.3}, {}, {}, {}, {}}, leg, knob}}).position = {4.0, 4.0, 1.0};
    Body& paddle = spec.add(Box{{2.0, 0.2, 1.0}}, BodyType::kinematic);
    paddle.keyframes = {{0.0, {0.0, 1.0, 0.0}, {}}, {1.0, {0.0, 2.0, 0.0}, AxisAngle{{0.0, 0.0, 1.0}, 30.0}}};
    paddle.interpolation = Interpolation::linear;
    spec.forces.push_back({"crate", {0.0, 0.5, 0.0}, {10.0, 0.0, 0.0}, true, 0.2, 0.7});
    spec.forces.push_back({"2", {}, {0.0, 1.0, 0.0}});
    spec.cords.push_back({"crate", {}, {0.0, 6.0, 0.0}, 0.02, {7, 8, 9}});
    return spec;
}

TEST(Spec, MovesLikeTheFileWithTheSameValues) {
    const SceneSpec spec = everything();
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    std::filesystem::create_symlink(spec.folder + "/torus.obj", folder / "torus.obj");
    std::filesystem::create_symlink(spec.folder + "/hoop.obj", folder / "hoop.obj");
    write_text(file, to_toml(spec));
    const Scene built(spec), loaded = load_scene(file);
    EXPECT_EQ(built.title(), spec.title);
    EXPECT_EQ(loaded.title(), spec.title);
    ASSERT_EQ(built.body_count(), spec.bodies.size());
    EXPECT_TRUE(same(after(built, 12), after(loaded, 12)));
    EXPECT_EQ(Renderer(built).render(after(built, 2)), Renderer(loaded).render(after(loaded, 2)));
    EXPECT_EQ(built.files().size(), 2u);
    EXPECT_EQ(loaded.files().size(), 3u);
}

TEST(Spec, HasTheDefaultsOfTheFormat) {
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, "format = 1\n[[body]]\nshape = { type = \"box\", size = [1, 1, 1] }\nposition = [0, 3, 0]\n");
    SceneSpec spec;
    spec.add(Box{{1.0, 1.0, 1.0}}).position = {0.0, 3.0, 0.0};
    const Scene built(spec), loaded = load_scene(file);
    EXPECT_EQ(built.frame_count(), loaded.frame_count());
    EXPECT_EQ(built.step(), loaded.step());
    EXPECT_EQ(built.output().width, loaded.output().width);
    EXPECT_EQ(Renderer(built).render(after(built, 5)), Renderer(loaded).render(after(loaded, 5)));
}

TEST(Spec, OptionsReplaceTheValuesOfTheFile) {
    const TestFolder folder;
    const std::string file = folder / "scene.toml";
    write_text(file, to_toml(crate_and_ball()));
    LoadOptions options;
    options.duration = 1.0;
    options.fps = 30.0;
    options.steps_per_frame = 2;
    options.width = 64;
    options.integrator = Integrator::exact;
    const Scene scene = load_scene(file, options);
    EXPECT_EQ(scene.frame_count(), 31);
    EXPECT_EQ(scene.duration(), 1.0);
    EXPECT_EQ(scene.step(), 1.0 / 60.0);
    EXPECT_EQ(scene.steps_per_frame(), 2);
    EXPECT_EQ(scene.output().width, 64);
    EXPECT_EQ(scene.output().height, 32);
}

TEST(Spec, BodiesHaveNamesAndTypes) {
    const Scene scene(crate_and_ball());
    EXPECT_EQ(scene.body_count(), 3u);
    EXPECT_EQ(scene.body_name(0), "0");
    EXPECT_EQ(scene.body_name(1), "crate");
    EXPECT_EQ(scene.find_body("crate"), 1u);
    EXPECT_EQ(scene.find_body("2"), 2u);
    EXPECT_FALSE(scene.find_body("none"));
    EXPECT_EQ(scene.body_type(0), BodyType::fixed);
    EXPECT_EQ(scene.body_type(1), BodyType::dynamic);
}

}  // namespace
}  // namespace tumble
