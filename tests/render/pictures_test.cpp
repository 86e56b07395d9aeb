// Draws one image of every kind of scene; each must be drawn without an error and have content. If TUMBLE_TEST_PICTURES
// names a folder, they are written there, for inspection.
#include "drawing.h"
#include "example_scenes.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

namespace tumble::pictures_test {
namespace {

void write_if_wanted(const Image& image, const std::string& name) {
    const char* folder = std::getenv("TUMBLE_TEST_PICTURES");
    if (folder == nullptr) return;
    png_image png;
    std::memset(&png, 0, sizeof png);
    png.version = PNG_IMAGE_VERSION;
    png.width = png_uint_32(image.width);
    png.height = png_uint_32(image.height);
    png.format = PNG_FORMAT_RGBA;
    const std::string path = (std::filesystem::path(folder) / (name + ".png")).string();
    EXPECT_NE(png_image_write_to_file(&png, path.c_str(), 0, image.pixels.data(), 0, nullptr), 0) << png.message;
}

std::size_t colors_in(const Image& image) {
    std::set<std::uint32_t> colors;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        std::uint32_t color = 0;
        std::memcpy(&color, &image.pixels[i], 4);
        colors.insert(color);
    }
    return colors.size();
}

// At a quarter of the scene's size, which is quick and shows the effect on fine detail; for inspection also in full
// size.
void draw(SceneDescription scene, const std::string& name) {
    const bool wanted = std::getenv("TUMBLE_TEST_PICTURES") != nullptr;
    if (wanted) write_if_wanted(drawn(scene), name);
    scene.output.width /= 4;
    scene.output.height /= 4;
    const Image image = drawn(scene);
    EXPECT_GT(colors_in(image), 100u) << name;
    write_if_wanted(image, name + "-small");
}

SceneDescription large(SceneDescription scene) {
    scene.output.width = 1280;
    scene.output.height = 720;
    return scene;
}

SceneDescription gallery_scene() {
    SceneDescription scene = large(empty_scene());
    scene.camera.eye = Vec3(3.0, 3.2, 7.5);
    scene.camera.target = Vec3(0.0, 0.6, 0.0);
    scene.bodies.push_back(ground_plane());
    const auto torus = torus_asset(0.7, 0.25);
    const Quat tilt(Eigen::AngleAxisd(0.6, Vec3(1.0, 0.3, 0.2).normalized()));
    scene.bodies.push_back(mesh_body(Vec3(-1.2, 0.25, 0.9), torus, {0xd9, 0x53, 0x4f}));
    scene.bodies.push_back(box_body(Vec3(-1.2, 0.3, 0.9), Vec3(0.6, 0.6, 0.6), {0xc8, 0x85, 0x3c}));
    scene.bodies.push_back(mesh_body(Vec3(2.0, 1.0, -0.6), torus, {0x4f, 0x9a, 0xd9}, tilt));
    for (int i = 0; i < 4; ++i) {
        BodyDescription ball = ball_body(Vec3(-2.4 + 1.4 * i, 0.5, -1.2), 0.5, {0x3c, 0x9d, 0x6b}, tilt);
        ball.appearance.roughness = 0.1 + 0.3 * i;
        scene.bodies.push_back(ball);
    }
    BodyDescription metal = ball_body(Vec3(0.9, 0.6, 1.2), 0.6, {0xe0, 0xb0, 0x50}, tilt);
    metal.appearance.metallic = 1.0;
    metal.appearance.roughness = 0.25;
    scene.bodies.push_back(metal);
    scene.bodies.push_back(box_body(Vec3(3.2, 0.5, 1.0), Vec3(0.25, 1.0, 0.6), {0xf2, 0xf0, 0xea}));
    scene.bodies.push_back(ball_body(Vec3(-0.2, 0.2, 2.6), 0.2, {0xd8, 0x3a, 0x3a}));
    BodyDescription patterned = box_body(Vec3(2.4, 0.4, 2.6), Vec3(0.8, 0.8, 0.8), {0x8a, 0x6f, 0xc8},
                                         Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY())));
    patterned.appearance.pattern = Pattern::checker;
    scene.bodies.push_back(patterned);
    scene.cords.push_back({3, Vec3::Zero(), Vec3(2.0, 4.0, -0.6), 0.02, {60, 60, 60}});
    return scene;
}

TEST(Pictures, Heap) { draw(heap_scene(100), "heap"); }
TEST(Pictures, BigHeap) { draw(heap_scene(1000), "big-heap"); }
TEST(Pictures, Gallery) { draw(gallery_scene(), "gallery"); }

TEST(Pictures, HeapOnChecker) {
    SceneDescription scene = heap_scene(100);
    scene.bodies[0].appearance.pattern = Pattern::checker;
    draw(scene, "heap-checker");
}

TEST(Pictures, OneBall) {
    SceneDescription scene = large(empty_scene());
    scene.camera.eye = Vec3(1.5, 1.6, 4.0);
    scene.camera.target = Vec3(0.0, 0.4, 0.0);
    scene.bodies = {ground_plane(), ball_body(Vec3(0.0, 0.5, 0.0), 0.5, {0xd8, 0x4a, 0x3a},
                                              Quat(Eigen::AngleAxisd(0.7, Vec3(0.3, 0.5, 1.0).normalized())))};
    draw(scene, "one-ball");
}

TEST(Pictures, NoGround) {
    SceneDescription scene = gallery_scene();
    scene.bodies.erase(scene.bodies.begin());
    scene.cords.clear();
    draw(scene, "no-ground");
}

TEST(Pictures, LowCamera) {
    SceneDescription scene = heap_scene(100);
    scene.camera.eye = Vec3(2.0, 0.35, 10.0);
    scene.camera.target = Vec3(0.0, 1.5, 0.0);
    draw(scene, "low-camera");
}

TEST(Pictures, FromAbove) {
    SceneDescription scene = heap_scene(100);
    scene.camera.eye = Vec3(0.0, 16.0, 0.0);
    scene.camera.target = Vec3(0.0, 0.0, 0.0);
    draw(scene, "from-above");
}

TEST(Pictures, Tiny) { draw(scaled(heap_scene(100), 1e-3), "tiny"); }
TEST(Pictures, Huge) { draw(scaled(heap_scene(100), 1e3), "huge"); }
TEST(Pictures, FarAway) { draw(moved(heap_scene(100), Vec3(1e6, 2e6, -3e6)), "far-away"); }

TEST(Pictures, Planes) {
    SceneDescription scene = large(empty_scene());
    scene.camera.eye = Vec3(4.0, 4.0, 9.0);
    scene.camera.target = Vec3(0.0, 1.0, 0.0);
    BodyDescription ramp = ground_plane({0xb9, 0x7a, 0x56}, Pattern::checker);
    ramp.shape = PlaneShape{Vec3(0.5, 0.8660254037844386, 0.0), 0.0};
    ramp.position = Vec3(-2.0, 0.0, 0.0);
    BodyDescription wall = ground_plane({0x9a, 0xa8, 0xb8}, Pattern::grid);
    wall.shape = PlaneShape{Vec3(0.0, 0.0, 1.0), -4.0};
    scene.bodies = {ground_plane(), ramp, wall, box_body(Vec3(1.0, 0.5, 0.0), Vec3::Ones(), {0xc8, 0x85, 0x3c}),
                    ball_body(Vec3(0.0, 0.6, 2.0), 0.6, {0x3a, 0x7d, 0xc8})};
    draw(scene, "planes");
}

}  // namespace
}  // namespace tumble::pictures_test
