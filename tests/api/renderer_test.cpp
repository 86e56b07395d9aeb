#include "scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tumble {
namespace {

std::vector<Snapshot> frames_of(const Scene& scene, int count) {
    World world(scene);
    std::vector<Snapshot> frames{world.snapshot()};
    while (int(frames.size()) < count) {
        world.advance_frame();
        frames.push_back(world.snapshot());
    }
    return frames;
}

TEST(Renderer, KeepsItsImageAndTheCallerMayKeepACopy) {
    const Scene scene(crate_and_ball());
    const std::vector<Snapshot> frames = frames_of(scene, 3);
    Renderer renderer(scene);
    const Image& image = renderer.render(frames[0]);
    EXPECT_EQ(image.width, 48);
    EXPECT_EQ(image.height, 32);
    ASSERT_EQ(image.pixels.size(), 48u * 32u * 4u);
    EXPECT_EQ(image.at(3, 5)[3], 255);
    const Image first = image;
    EXPECT_NE(renderer.render(frames[2]), first);
    EXPECT_EQ(renderer.render(frames[0]), first);
    EXPECT_FALSE(renderer.driver().empty());
}

TEST(Renderer, TwoTakeTurns) {
    SceneSpec spec = crate_and_ball();
    const Scene scene(spec);
    spec.output.width = 64;
    spec.light.shadows = false;
    const Scene other_scene(spec);
    const std::vector<Snapshot> frames = frames_of(scene, 4);
    Renderer first(scene), second(other_scene);
    std::vector<Image> images;
    for (const Snapshot& frame : frames) {
        images.push_back(first.render(frame));
        second.render(frame);
    }
    Renderer alone(scene);
    for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(alone.render(frames[i]), images[i]) << i;
}

TEST(Renderer, OutlivesTheScene) {
    const Snapshot snapshot = after(Scene(crate_and_ball()), 1);
    Renderer renderer{Scene(crate_and_ball())};
    Renderer moved = std::move(renderer);
    EXPECT_EQ(moved.render(snapshot), Renderer(Scene(crate_and_ball())).render(snapshot));
}

TEST(Renderer, DrawsOnAfterAnError) {
    const Scene scene(crate_and_ball());
    const std::vector<Snapshot> frames = frames_of(scene, 2);
    Renderer renderer(scene);
    const Image first = renderer.render(frames[0]);
    EXPECT_THROW(renderer.render({}), Error);
    EXPECT_EQ(renderer.render(frames[0]), first);
}

// A trembling body is drawn where it was: skipped frames count as drawn ones.
TEST(Renderer, SkippedFramesCount) {
    const Scene scene(crate_and_ball());
    Snapshot rest = after(scene, 0), trembling = rest;
    trembling.bodies[1].origin.x += 1e-6;
    Renderer renderer(scene), fresh(scene);
    renderer.skip(rest);
    EXPECT_EQ(renderer.render(trembling), fresh.render(rest));
}

TEST(AovRenderer, GivesTheSelectedValues) {
    SceneSpec spec = crate_and_ball();
    spec.camera.eye = Vec3{0.0, 3.0, 10.0};
    spec.camera.target = Vec3{0.0, 3.0, 0.0};
    spec.bodies[1].angular_velocity = {};
    spec.output = {33, 33, 10.0, 1};
    const Scene scene(spec);
    AovRenderer aovs(scene, {true, true, true, false, false});
    const AovFrame frame = aovs.render(after(scene, 0));
    ASSERT_EQ(frame.depth.size(), 33u * 33u);
    ASSERT_EQ(frame.normal.size(), 3u * 33u * 33u);
    EXPECT_TRUE(frame.motion.empty());
    EXPECT_TRUE(frame.albedo.empty());
    const std::size_t middle = 16 * 33 + 16;
    EXPECT_NEAR(frame.depth[middle], 9.5f, 1e-5f);  // the front face of the crate
    EXPECT_EQ(frame.segmentation[middle], 2);       // 1 + the index of the crate
    EXPECT_NEAR(frame.normal[3 * middle + 2], 1.0f, 1e-6f);
    EXPECT_TRUE(std::isinf(frame.depth[0]));
}

}  // namespace
}  // namespace tumble
