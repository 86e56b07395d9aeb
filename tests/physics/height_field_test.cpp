// Balls on height fields: as on a plane where it is flat, and to the bottom of a bowl.
#include "scene/load.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace tumble::height_field_test {
using namespace tumble::testing;

namespace {

/// A height field of 31 x 21 heights over 6 x 4 m, and a ball of radius 0.2 m.
template <class Height>
SceneDescription ball_on(const Height& height, const std::string& ball) {
    const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "height_field";
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / "heights.csv");
    for (int row = 0; row < 21; ++row)
        for (int column = 0; column < 31; ++column)
            file << height(0.2 * column - 3.0, 0.2 * row - 2.0) << (column < 30 ? "," : "\n");
    file.close();
    return parse_scene(
        "format = 1\n[[body]]\ntype = \"fixed\"\nrestitution = 0\nshape = { type = \"heightfield\", file = "
        "\"heights.csv\", size = [6, 4], height = 1 }\n[[body]]\nshape = { type = \"sphere\", radius = 0.2 }\n"
        "restitution = 0\nfriction = 0.5\n" +
            ball,
        folder / "scene.toml");
}

}  // namespace

TEST(HeightFields, ABallRollsStraightOverFlatCells) {
    const SceneDescription scene =
        ball_on([](double, double) { return 0.5; },
                "position = [-2.5, 0.7, 0.13]\nvelocity = [2, 0, 0]\nangular_velocity = [0, 0, -10]\n");
    World world(scene);
    for (int frame = 0; frame < 120; ++frame) {
        world.advance_frame();
        const Vec3 at = world.snapshot().bodies[1].origin;
        EXPECT_NEAR(at.y(), 0.7, 1e-6) << frame;
        EXPECT_NEAR(at.z(), 0.13, 1e-9) << frame;
    }
    EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 2.0, 1e-6);
}

TEST(HeightFields, ABallComesToRestAtTheBottomOfABowl) {
    const SceneDescription scene = ball_on([](double x, double z) { return 0.3 * (x * x + z * z); },
                                           "position = [1.0, 0.7, 0.5]\nrolling_friction = 0.1\n");
    World world(scene);
    run(world, scene, 8.0);
    const BodyState end = world.snapshot().bodies[1];
    EXPECT_LT(end.velocity.norm(), 1e-4);
    EXPECT_LT(Vec3(end.origin.x(), 0.0, end.origin.z()).norm(), 0.1 / 0.6 + 0.01) << "a slope of the rolling friction";
    EXPECT_NEAR(end.origin.y(), 0.2, 0.02);
}

}  // namespace tumble::height_field_test
