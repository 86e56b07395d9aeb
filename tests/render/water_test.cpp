// The water in pictures and AOVs.
#include "aov/world_rays.h"
#include "drawing.h"
#include "example_scenes.h"

#include "render/aov/water_depths.h"
#include "render/scene/pose_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::water_test {
namespace {

/// A box that pierces the surface, a sunken one and a floor.
SceneDescription harbor() {
    SceneDescription scene = empty_scene();
    scene.output.width = 232;
    scene.output.height = 152;
    scene.camera.eye = Vec3(1.0, 2.5, 6.0);
    scene.camera.target = Vec3(0.0, 0.8, 0.0);
    scene.bodies = {ground_plane(), box_body(Vec3(0.0, 1.0, 0.0), Vec3(1.5, 1.5, 1.5), {220, 120, 60}),
                    box_body(Vec3(1.6, 0.3, 0.6), Vec3(0.5, 0.5, 0.5), {230, 230, 230})};
    scene.water.emplace().level = 0.9;
    return scene;
}

SceneDescription with_waves() {
    SceneDescription scene = harbor();
    scene.water->waves = {{0.15, 2.0, Vec3(0.8, 0.0, 0.6), 20.0}, {0.05, 0.7, Vec3(-0.6, 0.0, 0.8), 80.0}};
    return scene;
}

AovFrame aovs_of(const SceneDescription& scene, double time = 0.0) {
    AovSet aovs;
    for (const Aov aov : all_aovs) aovs.add(aov);
    Snapshot snapshot = first_snapshot(scene);
    snapshot.time = time;
    return AovRenderer(scene, aovs).make({snapshot, snapshot});
}

int largest_difference(const Image& a, const Image& b, Pixel at) {
    int most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(int(a.at(at.x, at.y)[c]) - int(b.at(at.x, at.y)[c])));
    return most;
}

}  // namespace

TEST(Water, BelowAllThatIsSeenItChangesNoPixel) {
    SceneDescription scene = harbor(), dry = scene;
    dry.water.reset();
    scene.water->level = -0.5;
    EXPECT_EQ(drawn(scene), drawn(dry));
    scene.water->level = 0.9;
    EXPECT_NE(drawn(scene), drawn(dry));
    RenderSwitches transparent;
    transparent.transparent = true;
    EXPECT_EQ(drawn(scene, transparent), drawn(dry, transparent));
}

TEST(Water, LeavesBodiesAboveAsTheyAre) {
    SceneDescription scene = harbor(), dry = scene;
    dry.water.reset();
    const Image wet = drawn(scene), without = drawn(dry);
    const Pixel top = pixel_of(scene, Vec3(0.0, 1.75, 0.0)), side = pixel_of(scene, Vec3(0.1, 1.3, 0.75));
    const Pixel below = pixel_of(scene, Vec3(0.1, 0.6, 0.75)), floor = pixel_of(scene, Vec3(-2.0, 0.0, 2.0));
    EXPECT_EQ(largest_difference(wet, without, top), 0);
    EXPECT_EQ(largest_difference(wet, without, side), 0);
    EXPECT_GT(largest_difference(wet, without, below), 30);
    EXPECT_GT(largest_difference(wet, without, floor), 30);
}

// Beer's law: red is lost first, and of black and white floors far below the same light is left.
TEST(Water, TintsByTheWayOfTheLight) {
    SceneDescription scene = empty_scene();
    scene.camera.eye = Vec3(0.5, 6.0, 0.5);
    scene.camera.target = Vec3(0.0, 0.0, 0.0);
    scene.bodies = {ground_plane({255, 255, 255}, Pattern::plain)};
    scene.water.emplace();
    const auto color = [&](double level, int shade) {
        const auto byte = std::uint8_t(shade);
        scene.bodies[0].appearance.color = {byte, byte, byte};
        scene.bodies[0].position.y() = -level;
        const Image image = drawn(scene);
        const std::uint8_t* pixel = image.at(scene.output.width / 2, scene.output.height / 2);
        return std::array<int, 3>{pixel[0], pixel[1], pixel[2]};
    };
    int red = 256;
    for (const double depth : {0.1, 0.5, 1.0, 2.0, 4.0}) {
        const auto white = color(depth, 255);
        EXPECT_LT(white[0], red) << depth;
        red = white[0];
    }
    EXPECT_GT(color(1.0, 255)[2], color(1.0, 255)[0] + 40);
    EXPECT_GT(color(0.1, 255)[1], color(0.1, 0)[1] + 60);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color(60.0, 255)[std::size_t(c)], color(60.0, 0)[std::size_t(c)], 1);
}

// Along the water line on a wall pixels have shares of both sides: a step of one row between adjacent columns
// never appears at once.
TEST(Water, TheWaterLineIsSmooth) {
    SceneDescription scene = harbor();
    scene.camera.up = Vec3(0.2, 1.0, 0.0).normalized();  // a slanted line
    scene.bodies = {ground_plane({40, 30, 30}, Pattern::plain)};
    scene.bodies[0].shape = PlaneShape{Vec3(0.0, 0.0, 1.0), 0.75};
    const Image image = drawn(scene);
    const Pixel left = pixel_of(scene, Vec3(-0.5, 0.9, 0.75)), right = pixel_of(scene, Vec3(0.5, 0.9, 0.75));
    int between = 0, columns = 0;
    for (int x = left.x; x <= right.x; ++x, ++columns) {
        const int y = left.y + (right.y - left.y) * (x - left.x) / (right.x - left.x);
        const int above = int(brightness(image, {x, y - 4})), below = int(brightness(image, {x, y + 4}));
        ASSERT_GT(std::abs(above - below), 15);
        for (int row = y - 3; row <= y + 3; ++row) {
            const double share = (brightness(image, {x, row}) - above) / (below - above);
            between += share > 0.12 && share < 0.88 ? 1 : 0;
        }
    }
    EXPECT_GT(between, columns / 2);
}

TEST(Water, WavesMoveAndStillWaterDoesNot) {
    const SceneDescription waves = with_waves(), still = harbor();
    for (const SceneDescription& scene : {waves, still}) {
        Snapshot snapshot = first_snapshot(scene);
        Renderer renderer(scene);
        PoseFilter filter(scene);
        const bool moves = !scene.water->waves.empty();
        EXPECT_TRUE(filter.follow(snapshot));
        const Image first = renderer.render(snapshot);
        snapshot.time = 0.1;
        EXPECT_EQ(filter.follow(snapshot), moves);
        EXPECT_EQ(renderer.render(snapshot) != first, moves);
        EXPECT_EQ(renderer.changed().empty(), !moves);
    }
}

TEST(Water, ABodyThatMovesIsDrawnAsInAFreshFrame) {
    for (const SceneDescription& scene : {with_waves(), harbor()}) {
        Snapshot snapshot = first_snapshot(scene);
        Renderer renderer(scene);
        renderer.render(snapshot);
        snapshot.time = 0.3;
        snapshot.bodies[1].origin.y() -= 0.4;
        EXPECT_EQ(renderer.render(snapshot), Renderer(scene).render(snapshot));
        renderer.render(snapshot);
        EXPECT_TRUE(renderer.changed().empty());
    }
}

TEST(Water, TheEyeMayBeInIt) {
    SceneDescription scene = harbor();
    const Vec3 wall(0.0, 0.5, 0.75);
    scene.camera.eye.y() = 0.5;
    SceneDescription dry = scene;
    dry.water.reset();
    EXPECT_GT(largest_difference(drawn(scene), drawn(dry), pixel_of(scene, wall)), 30);
}

TEST(WaterAovs, StillWaterIsAPlaneWithAnIdOfItsOwn) {
    SceneDescription scene = harbor();
    SceneDescription plane = scene;
    plane.water.reset();
    plane.bodies.push_back(ground_plane());
    plane.bodies.back().position.y() = 0.9;
    const AovFrame water = aovs_of(scene), expected = aovs_of(plane);
    EXPECT_EQ(water.segmentation, expected.segmentation);
    EXPECT_EQ(water.normal, expected.normal);
    for (std::size_t i = 0; i < water.depth.size(); ++i) {
        if (!std::isfinite(expected.depth[i])) continue;
        EXPECT_NEAR(water.depth[i] / expected.depth[i], 1.0, 2e-7);
    }
    EXPECT_TRUE(std::ranges::all_of(water.motion, [](float way) { return way == 0.0f; }));
    const auto pixel = std::ranges::find(water.segmentation, 4) - water.segmentation.begin();
    EXPECT_EQ(water.albedo[std::size_t(3 * pixel)], scene.water->color.r);

    scene.water->visible_in_aov = false;
    plane.bodies.pop_back();
    EXPECT_EQ(aovs_of(scene).depth, aovs_of(plane).depth);
}

TEST(WaterAovs, ARayEndsAtTheFirstWave) {
    const SceneDescription scene = with_waves();
    const double time = 0.7;
    const WaterSurface surface(*scene.water, 9.81);
    const WorldView view(scene);
    int met = 0;
    for (const double height : {1.05, 2.5})
        for (int row = 0; row < scene.output.height; row += 3)
            for (int column = 0; column < scene.output.width; column += 3) {
                const Vec3 eye(1.0, height, 6.0), ray = view.ray(column, row).direction;
                const double depth = water_depth(surface, time, eye, ray);
                const auto over = [&](double d) {
                    const Vec3 p = eye + d * ray;
                    return p.y() - surface.height(p.x(), p.z(), time);
                };
                if (depth > 40.0) continue;
                ++met;
                EXPECT_NEAR(over(depth), 0.0, 1e-9);
                for (double d = 0.0; d < depth - 0.01; d += 0.005) ASSERT_GT(over(d), -2e-4) << d << " " << depth;
            }
    EXPECT_GT(met, 2000);
}

TEST(WaterAovs, NormalsAreThoseOfTheWaves) {
    const SceneDescription scene = with_waves();
    const AovFrame frame = aovs_of(scene, 0.4);
    const WaterSurface surface(*scene.water, 9.81);
    const WorldView view(scene);
    int seen = 0;
    for (int row = 0; row < scene.output.height; ++row)
        for (int column = 0; column < scene.output.width; ++column) {
            const auto pixel = std::size_t(row * scene.output.width + column);
            if (frame.segmentation[pixel] != 4 || frame.depth[pixel] > 20.0f) continue;
            ++seen;
            const Vec3 p = view.ray(column, row).at(frame.depth[pixel]);
            const Vec3 normal(frame.normal[3 * pixel], frame.normal[3 * pixel + 1], frame.normal[3 * pixel + 2]);
            const Vec3 expected = surface.normal(p.x(), p.z(), 0.4);
            EXPECT_LT(std::min((normal - expected).norm(), (normal + expected).norm()), 1e-4);
        }
    EXPECT_GT(seen, 5000);
}

}  // namespace tumble::water_test
