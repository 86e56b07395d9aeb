// Bodies that overlap: their depth, and its share of the smaller one's thickness.
#include "scene/load.h"
#include "sim/world.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

namespace tumble::overlaps_test {
using namespace tumble::testing;

TEST(Overlaps, ABallInAPlane) {
    SceneDescription scene = ground_scene(0.0, 0.0);
    add_sphere(scene, 0.5, Vec3(0.0, 0.4, 0.0));
    const std::vector<Overlap> found = World(scene).overlaps();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].a, 0u);
    EXPECT_EQ(found[0].b, 1u);
    EXPECT_NEAR(found[0].depth, 0.1, 1e-12);
    EXPECT_NEAR(found[0].share, 0.1, 1e-12);  // of the diameter
}

TEST(Overlaps, BoxesInAnyModeAndAnywhere) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact})
        for (const double far : {0.0, 1000.0}) {
            SceneDescription scene = empty_scene();
            scene.simulation.impacts = mode;
            add_box(scene, Vec3(4.0, 0.2, 4.0), Vec3(far, 0.0, 0.0));
            add_box(scene, Vec3(1.0, 1.0, 1.0), Vec3(far, 0.55, 0.0));
            const std::vector<Overlap> found = World(scene).overlaps();
            ASSERT_EQ(found.size(), 1u);
            EXPECT_NEAR(found[0].depth, 0.05, 1e-9);
            EXPECT_NEAR(found[0].share, 0.25, 1e-8);  // of the plate's thickness
        }
}

// Several parts of one pair give one row, with the deepest.
TEST(Overlaps, ACompoundIsOneBody) {
    SceneDescription scene = ground_scene(0.0, 0.0);
    CompoundPart low, high;
    low.shape = SphereShape{0.5};
    high.shape = SphereShape{0.5};
    high.position = Vec3(2.0, 0.1, 0.0);
    const auto parts = std::make_shared<const std::vector<CompoundPart>>(std::vector<CompoundPart>{low, high});
    add_body(scene, CompoundShape{parts}, Vec3(0.0, 0.3, 0.0)).mass = 1.0;
    const std::vector<Overlap> found = World(scene).overlaps();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].depth, 0.2, 1e-12);
}

TEST(Overlaps, NotOfBodiesThatCannotMoveTouchOrAreJoined) {
    const std::string apart = R"(format = 1
[[body]]
type = "fixed"
shape = { type = "plane" }
[[body]]
type = "kinematic"
shape = { type = "box", size = [1, 1, 1] }
[[body]]
shape = { type = "box", size = [1, 1, 1] }
position = [5, 0.5, 0]
[[body]]
name = "a"
shape = { type = "box", size = [1, 0.2, 1] }
position = [10, 3, 0]
[[body]]
name = "b"
shape = { type = "box", size = [1, 0.2, 1] }
position = [10.5, 3, 0]
[[joint]]
type = "hinge"
bodies = ["a", "b"]
anchor = [10.25, 3, 0]
axis = [0, 0, 1]
)";
    for (const Overlap& overlap : World(parse_scene(apart, "scene.toml")).overlaps()) EXPECT_LT(overlap.share, 1e-9);
    const std::vector<Overlap> found = World(parse_scene(apart + "collide = true\n", "scene.toml")).overlaps();
    const auto deep = std::find_if(found.begin(), found.end(), [](const Overlap& o) { return o.share > 0.01; });
    ASSERT_NE(deep, found.end());
    EXPECT_EQ(deep->a, 3u);
    EXPECT_EQ(deep->b, 4u);
}

}  // namespace tumble::overlaps_test
