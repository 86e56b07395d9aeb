// Small pictures against what they should be: the mean of 64 samples a pixel (picture_reference measures large ones).
#include "accumulated.h"
#include "example_scenes.h"

#include "render/renderer.h"
#include "scene/load.h"

#include <gtest/gtest.h>

namespace tumble::reference_test {
namespace {

void expect_like_reference(SceneDescription scene, double flip, int above_32, int above_64) {
    scene.output.width = 320;
    scene.output.height = 180;
    const Snapshot snapshot = first_snapshot(scene);
    const Unlikeness found = unlikeness(accumulated(scene, snapshot, 8), Renderer(scene).render(snapshot));
    EXPECT_LT(found.mean_flip, flip) << scene.file;
    EXPECT_LE(found.above[1], above_32) << scene.file << ": pixels that differ by more than 32 levels";
    EXPECT_LE(found.above[2], above_64) << scene.file << ": pixels that differ by more than 64 levels";
}

TEST(Reference, IsLikeWhiteBodiesOnPlainGround) {
    expect_like_reference(parse_scene(R"(format = 1
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
shape = { type = "sphere", radius = 1 }
position = [0, 1, 0]
pattern = "plain"
color = "#ffffff"
[[body]]
shape = { type = "box", size = [1, 1, 1] }
position = [2, 0.5, 0]
pattern = "plain"
color = "#ffffff"
)",
                                      "white.toml"),
                          0.02, 0, 0);
}

// Two boxes beside each other in the plane of the picture, a third of a pixel apart: few pixel centers are in the gap.
TEST(Reference, IsLikeNarrowGap) {
    expect_like_reference(parse_scene(R"(format = 1
[camera]
eye = [0, 1, 6]
target = [0, 1, 0]
vertical_fov = 40
[[body]]
type = "fixed"
shape = { type = "box", size = [1, 1.6, 0.02] }
position = [-0.473605, 0.827622, 0]
rotation = { axis = [0, 0, 1], angle = 20 }
pattern = "plain"
color = "#303030"
[[body]]
type = "fixed"
shape = { type = "box", size = [1, 1.6, 0.02] }
position = [0.473605, 1.172378, 0]
rotation = { axis = [0, 0, 1], angle = 20 }
pattern = "plain"
color = "#303030"
)",
                                      "gap.toml"),
                          0.02, 130, 10);
}

// Their small bodies have edges that are nearer to each other than pixels.
TEST(Reference, IsLikeDemoScenes) {
    for (const char* name : {"bouncing_balls", "tower_hit", "turntable"})
        expect_like_reference(load_scene(std::string(TUMBLE_SOURCE_DIR "/assets/scenes/") + name + ".toml"), 0.02, 80,
                              10);
}

// Rounding decides from which side their faces at the height of the eye are seen.
TEST(Reference, IsLikeFacesSeenEdgeOn) {
    SceneDescription scene = load_scene(TUMBLE_SOURCE_DIR "/assets/scenes/tower_hit.toml");
    scene.camera.eye = Vec3(5.2, 2.7, 6.9);
    scene.camera.target = Vec3(0.35, 1.25, 0.0);
    expect_like_reference(scene, 0.02, 80, 5);
}

}  // namespace
}  // namespace tumble::reference_test
