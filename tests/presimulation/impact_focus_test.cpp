// focus = "impact": a body is cut about the place of the blow that breaks it, and the motion before is as without it.
#include "presimulation/impact_focus.h"

#include "scene/load.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tumble::impact_focus_test {
namespace {

SceneDescription scene_of(const std::string& text) {
    return focused_on_impacts(parse_scene("format = 1\n" + text, "focus.toml"));
}

std::string pane(const std::string& name, const std::string& place, const std::string& focus = "\"impact\"") {
    return "[[body]]\nname = \"" + name + "\"\ntype = \"fixed\"\nmaterial = \"glass\"\n" +
           "shape = { type = \"box\", size = [0.6, 0.5, 0.006] }\nposition = " + place +
           "\nfracture = { cells = 60, pattern = \"radial\", focus = " + focus +
           ", held = [\"-x\", \"+x\", \"-y\", \"+y\"] }\n";
}

std::string ball(const std::string& name, const std::string& position, const std::string& velocity) {
    return "[[body]]\nname = \"" + name +
           "\"\nshape = { type = \"sphere\", radius = 0.04 }\ndensity = 7800\nrestitution = 0.9\nposition = " +
           position + "\nvelocity = " + velocity + "\n";
}

const std::string glass = "[materials.glass]\ndensity = 2500\nstrength = 30e6\nstiffness = 70e9\ntoughness = 8\n";

std::string settings(const std::string& mode) {
    return "[simulation]\nduration = 1\ngravity = [0, 0, 0]\nimpacts = \"" + mode + "\"\n" + glass;
}

std::size_t breaks_of(const SceneDescription& scene) {
    World world(scene);
    std::size_t breaks = 0;
    for (int n = 1; n < scene.frame_count(); ++n) {
        world.advance_frame();
        breaks += world.breaks().size();
    }
    return breaks;
}

TEST(ImpactFocus, LiesWhereTheBallBreaksThePane) {
    for (const std::string mode : {"stepped", "exact"}) {
        const SceneDescription scene =
            scene_of(settings(mode) + pane("pane", "[1, 2, 3]") + ball("ball", "[1.12, 1.91, 3.5]", "[0, 0, -9]"));
        const FractureDescription& fracture = *scene.bodies[0].fracture;
        ASSERT_TRUE(fracture.focus) << mode;
        EXPECT_LT((*fracture.focus - Vec3(0.12, -0.09, 0.003)).norm(), 1e-12) << mode;
        EXPECT_GT(breaks_of(scene), 10u) << mode;
        // The same cut as with this point.
        const SceneDescription given =
            parse_scene("format = 1\n" + settings(mode) + pane("pane", "[1, 2, 3]", "[0.12, -0.09, 0.003]") +
                            ball("ball", "[1.12, 1.91, 3.5]", "[0, 0, -9]"),
                        "given.toml");
        EXPECT_EQ(given.bodies.size(), scene.bodies.size());
        EXPECT_EQ(given.bodies[0].fracture->bonds.size(), fracture.bonds.size());
    }
}

// The first ball is too slow, the second one breaks the pane; its ball goes on to the next pane.
TEST(ImpactFocus, IsThePlaceOfTheBlowThatBreaks) {
    const SceneDescription scene = scene_of(
        settings("stepped") + pane("near", "[0, 0, 0]") + pane("far", "[0, 0, -0.3]") + pane("untouched", "[5, 0, 0]") +
        ball("slow", "[-0.15, 0.1, 0.06]", "[0, 0, -0.05]") + ball("fast", "[0.1, -0.05, 8.0]", "[0, 0, -14]"));
    const auto focus = [&](std::size_t body) { return scene.bodies[body].fracture->focus; };
    ASSERT_TRUE(focus(0) && focus(1));
    EXPECT_LT((*focus(0) - Vec3(0.1, -0.05, 0.003)).norm(), 1e-9);
    EXPECT_LT((*focus(1) - Vec3(0.1, -0.05, 0.003)).norm(), 0.03);  // splinters deflect it
    EXPECT_FALSE(focus(2));
}

// Its own weight breaks a beam that its ends hold: the focus is a bond.
TEST(ImpactFocus, OfALoadIsItsBond) {
    const SceneDescription scene = scene_of(
        "[simulation]\nduration = 1\n[[body]]\ntype = \"fixed\"\ndensity = 2000\nstrength = 2e5\n"
        "shape = { type = \"box\", size = [4, 0.1, 0.3] }\n"
        "fracture = { cells = 12, focus = \"impact\", held = [\"-x\", \"+x\"] }\n");
    ASSERT_TRUE(scene.bodies[0].fracture->focus);
    EXPECT_LT(std::abs(scene.bodies[0].fracture->focus->y()), 0.06);
}

TEST(ImpactFocus, LeavesOtherScenes) {
    const std::string text =
        settings("stepped") + pane("pane", "[0, 0, 0]", "[0.1, 0, 0]") + ball("ball", "[0, 0, 0.5]", "[0, 0, -9]");
    EXPECT_EQ(*scene_of(text).bodies[0].fracture->focus, Vec3(0.1, 0.0, 0.0));
}

}  // namespace
}  // namespace tumble::impact_focus_test
