// Sliders and choices of live pages: their ranges, and the mistakes in them.
#include "app/page/live_controls.h"
#include "core/error.h"

#include <gtest/gtest.h>

namespace tumble::live_controls_test {
namespace {

constexpr const char* scene =
    "format = 1\n"
    "[simulation]\nduration = 1.0\ngravity = [0, -10, 0]\nimpacts = \"exact\"\n"
    "[[body]]\nname = \"ball\"\nshape = { type = \"sphere\", radius = 0.5 }\nposition = [0, 2, 0]\nrestitution = 0.8\n";

LiveControl completed(const std::string& text) {
    std::vector<LiveControl> controls{parse_live_control(text)};
    complete_live_controls(controls, scene, "ball.toml", {});
    return controls.front();
}

std::string problem(const std::string& text) {
    try {
        completed(text);
    } catch (const InputError& error) {
        return error.message();
    }
    return "";
}

TEST(LiveControls, ARangeIsMadeAroundTheValue) {
    const LiveControl control = completed("body.ball.restitution");
    EXPECT_EQ(control.min, "0");
    EXPECT_EQ(control.max, "1");  // 1.6 is no restitution
    EXPECT_EQ(control.step, "0.05");
    EXPECT_EQ(control.value, "0.8");
    EXPECT_EQ(control.label, "restitution of ball");
}

TEST(LiveControls, AComponentOfAVectorHasARangeToo) {
    const LiveControl control = completed("simulation.gravity.1");
    EXPECT_EQ(control.min, "-20");
    EXPECT_EQ(control.max, "0");
    EXPECT_EQ(control.step, "0.5");
    EXPECT_EQ(control.label, "gravity, y");
    EXPECT_EQ(control.unit, "m/s²");
}

TEST(LiveControls, ALengthDoesNotReachZero) { EXPECT_EQ(completed("body.ball.shape.radius").min, "0.05"); }

TEST(LiveControls, AGivenRangeIsKept) {
    const LiveControl control = completed("simulation.steps_per_frame=2:16:2");
    EXPECT_EQ(control.min, "2");
    EXPECT_EQ(control.step, "2");
    EXPECT_EQ(control.value, "");
}

TEST(LiveControls, ChoicesAreTexts) {
    const LiveControl control = completed("simulation.impacts=exact,stepped");
    EXPECT_EQ(control.choices, (std::vector<std::string>{"exact", "stepped"}));
    EXPECT_EQ(control.value, "exact");
}

TEST(LiveControls, MistakesAreNamed) {
    EXPECT_NE(problem("=0:1:1").find("has no key"), std::string::npos);
    EXPECT_NE(problem("body.ball.restitution=0:2:0.1").find("not valid with 2"), std::string::npos);
    EXPECT_NE(problem("body.ball.restitution=1:0:0.1").find("goes up"), std::string::npos);
    EXPECT_NE(problem("body.ball.restitution=0:1e0:0.1").find("decimal numbers"), std::string::npos);
    EXPECT_NE(problem("body.box.restitution").find("there is no element \"box\""), std::string::npos);
    EXPECT_NE(problem("simulation.integrator").find("is not in the scene"), std::string::npos);
    EXPECT_NE(problem("simulation.impacts").find("give its values"), std::string::npos);
    EXPECT_NE(problem("body.ball.restitution=0.5").find("must be a range"), std::string::npos);
}

TEST(LiveControls, ThePageHasThemAsJson) {
    LivePage page{.name = "ball.toml", .settings = {}, .controls = {completed("body.ball.restitution")}};
    EXPECT_EQ(
        live_json(page),
        R"({"name":"ball.toml","source":0,"settings":[],"controls":[{"key":"body.ball.restitution",)"
        R"("label":"restitution of ball","unit":"","min":"0","max":"1","step":"0.05","value":"0.8"}],"editor":true})");
}

}  // namespace
}  // namespace tumble::live_controls_test
