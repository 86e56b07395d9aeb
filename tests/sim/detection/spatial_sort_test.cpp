// Bodies in memory sorted by place: columns side by side, with no visible effect outside.
#include "sim/detection/spatial_sort.h"

#include "sim/dynamics/body_builder.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::spatial_sort_test {
using namespace tumble::testing;

namespace {

// Balls in a grid, two meters apart; neighbors in the list are far from each other.
SceneDescription scattered(int across, int up, int deep) {
    SceneDescription scene = empty_scene(4);
    scene.simulation.gravity = Vec3(0.0, -9.81, 0.0);
    const int count = across * up * deep;
    for (int n = 0; n < count; ++n) {
        const int k = n * 37 % count;  // 37 is no factor of the counts used here
        add_sphere(scene, 0.3, 2.0 * Vec3(k % across, k / across % up, k / (across * up)), 1.0 + 0.01 * n);
    }
    return scene;
}

TEST(SpatialSort, HalvesAreApartAcrossGravityAndColumnsGoUp) {
    const SceneDescription scene = scattered(16, 4, 10);
    auto bodies = build_bodies(scene);
    const auto order = put_in_memory_order(bodies, scene.simulation.gravity);
    ASSERT_EQ(order.size(), 640u);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(bodies[i].name, scene.bodies[order[i]].name);
    const auto x = [&](std::size_t i) { return bodies[i].position.x(); };
    double last = -1.0;
    for (std::size_t i = 0; i < 320; ++i) last = std::max(last, x(i));
    for (std::size_t i = 320; i < 640; ++i) EXPECT_GT(x(i), last);
    for (std::size_t i = 1; i < 20; ++i)
        EXPECT_GE(bodies[i].position.y(), bodies[i - 1].position.y()) << i;  // 640 in halves: 20
}

TEST(SpatialSort, SmallScenesKeepTheirOrder) {
    const SceneDescription scene = scattered(8, 7, 9);
    auto bodies = build_bodies(scene);
    const auto order = put_in_memory_order(bodies, scene.simulation.gravity);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

// The scene's values of each body apply to that body.
TEST(SpatialSort, SnapshotsReportsAndForcesUseTheSceneOrder) {
    SceneDescription scene = scattered(16, 4, 10);
    scene.bodies[5].type = BodyType::fixed;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].velocity = Vec3(0.001 * double(i), 0.0, 0.0);
    ForceDescription force;
    force.body = 411;
    force.force = Vec3(0.0, 0.0, 30.0);
    force.end = 1.0;
    scene.forces.push_back(force);
    World world(scene, 2);
    for (int frame = 0; frame < 6; ++frame) world.advance_frame();
    const Snapshot snapshot = world.snapshot();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Vec3 way = snapshot.bodies[i].center_of_mass - scene.bodies[i].position;
        EXPECT_NEAR(way.x(), i == 5 ? 0.0 : 0.1 * 0.001 * double(i), 1e-12) << i;
        EXPECT_EQ(way.z() != 0.0, i == 411) << i;
        if (i != 5) {
            EXPECT_NEAR(world.report(i).mass, 1.0 + 0.01 * double(i), 1e-9) << i;
        }
    }
    EXPECT_TRUE(std::isinf(world.report(5).mass));
}

}  // namespace

}  // namespace tumble::spatial_sort_test
