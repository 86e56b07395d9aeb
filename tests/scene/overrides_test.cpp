// Options of the command line that override the file.
#include "core/error.h"
#include "scene/load.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::overrides_test {
namespace {

SceneDescription parse(const std::string& text, const SceneOverrides& overrides) {
    return parse_scene(text, "scene.toml", overrides);
}

std::string error_of(const std::string& text, const SceneOverrides& overrides) {
    try {
        parse(text, overrides);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

const std::string with_step = "format = 1\n[simulation]\nstep = 0.0005\n[output]\nfps = 50\n";
const std::string with_count = "format = 1\n[simulation]\nsteps_per_frame = 3\n";

TEST(Overrides, WinOverTheFile) {
    SceneOverrides overrides;
    overrides.duration = 1.5;
    overrides.fps = 100.0;
    overrides.steps_per_frame = 7;
    overrides.width = 320;
    overrides.height = 200;
    overrides.samples = 1;
    overrides.integrator = "explicit-euler";
    overrides.impacts = "stepped";
    overrides.impact_law = "simultaneous";
    const SceneDescription scene = parse(with_count, overrides);
    EXPECT_EQ(scene.simulation.duration, 1.5);
    EXPECT_EQ(scene.output.fps, 100.0);
    EXPECT_EQ(scene.simulation.steps_per_frame, 7);
    EXPECT_EQ(scene.output.width, 320);
    EXPECT_EQ(scene.output.height, 200);
    EXPECT_EQ(scene.output.samples, 1);
    EXPECT_EQ(scene.simulation.integrator, IntegratorKind::explicit_euler);
    EXPECT_EQ(scene.simulation.impact_law, ImpactLaw::simultaneous);
}

TEST(Overrides, AStepOrACountReplacesBothKeysOfTheFile) {
    SceneOverrides count, step;
    count.steps_per_frame = 10;
    step.step = 0.01;
    EXPECT_EQ(parse(with_step, count).simulation.steps_per_frame, 10);
    EXPECT_EQ(parse(with_step, step).simulation.steps_per_frame, 2);
    EXPECT_EQ(
        parse("format = 1\n[simulation]\nsteps_per_frame = 3\n[output]\nfps = 50", step).simulation.steps_per_frame, 2);
}

TEST(Overrides, AnotherFrameRateChecksTheFilesStepAgain) {
    SceneOverrides overrides;
    overrides.fps = 100.0;
    EXPECT_EQ(parse(with_step, overrides).simulation.steps_per_frame, 20);
    overrides.fps = 60.0;
    EXPECT_EQ(error_of(with_step, overrides),
              "error: --fps: does not fit: a step must divide the frame's 1/60 s; the nearest that does is "
              "0.000505050505050505 s (given a step of 0.0005 s)");
}

TEST(Overrides, AnotherFrameRateMayFitTheFilesStep) {
    SceneOverrides overrides;
    overrides.fps = 50.0;
    EXPECT_EQ(parse("format = 1\n[simulation]\nstep = 0.0005\n", overrides).simulation.steps_per_frame, 40);
}

TEST(Overrides, ErrorsNameTheOption) {
    const auto error = [](auto set) {
        SceneOverrides overrides;
        set(overrides);
        return error_of(with_count, overrides);
    };
    EXPECT_EQ(error([](auto& o) { o.fps = -1.0; }),
              "error: --fps: must be from 1e-09 to 1000000 frames per second (given -1)");
    EXPECT_EQ(error([](auto& o) { o.fps = std::nan(""); }), "error: --fps: must be a finite number (given nan)");
    EXPECT_EQ(error([](auto& o) { o.duration = -0.5; }),
              "error: --duration: must be from 0 to 1000000000 s (given -0.5)");
    EXPECT_EQ(error([](auto& o) { o.steps_per_frame = 0; }),
              "error: --steps-per-frame: must be from 1 to 1000000 (given 0)");
    EXPECT_EQ(error([](auto& o) { o.step = 0.0; }),
              "error: --step: must be above 0 and at most 1000000000 s (given 0)");
    EXPECT_EQ(error([](auto& o) { o.step = 0.01; }),
              "error: --step: does not fit: a step must divide the frame's 1/60 s; the nearest that does is "
              "0.008333333333333333 s (given a step of 0.01 s)");
    EXPECT_EQ(error([](auto& o) { o.step = 0.01, o.steps_per_frame = 2; }),
              "error: --step: cannot be given together with --steps-per-frame: give one of them");
    EXPECT_EQ(error([](auto& o) { o.width = 0; }), "error: --size: must be from 1 to 16384 (given 0)");
    EXPECT_EQ(error([](auto& o) { o.height = 99999; }), "error: --size: must be from 1 to 16384 (given 99999)");
    EXPECT_EQ(error([](auto& o) { o.samples = 3; }), "error: --samples: must be 1, 2 or 4 (given 3)");
    EXPECT_EQ(error([](auto& o) { o.integrator = "verlet"; }),
              "error: --integrator: must be one of \"symplectic-euler\", \"explicit-euler\", \"exact\", \"splitting\", "
              "\"rk4\" (given \"verlet\")");
    EXPECT_EQ(error([](auto& o) { o.impacts = "continuous"; }),
              "error: --impacts: must be one of \"stepped\", \"exact\" (given \"continuous\")");
    EXPECT_EQ(error([](auto& o) { o.impact_law = "both"; }),
              "error: --impact-law: must be one of \"propagating\", \"simultaneous\" (given \"both\")");
    EXPECT_EQ(error([](auto& o) { o.duration = 1e6; }),
              "error: --duration: makes too many frames: 1000000 s at 60 frames a second are 6e+07, and the limit is "
              "10000000 "
              "(given 1000000)");
}

TEST(Overrides, TheIntegratorIsThatOfEveryBody) {
    const std::string text =
        "format = 1\n[[body]]\nshape = { type = \"sphere\", radius = 1 }\nintegrator = \"explicit-euler\"\n";
    SceneOverrides overrides;
    EXPECT_EQ(parse(text, overrides).bodies[0].integrator, IntegratorKind::explicit_euler);
    overrides.integrator = "symplectic-euler";
    EXPECT_FALSE(parse(text, overrides).bodies[0].integrator.has_value());
}

TEST(Overrides, TheFilesOwnMistakesStayMistakes) {
    SceneOverrides overrides;
    overrides.fps = 30.0;
    EXPECT_EQ(error_of("format = 1\n[output]\nfps = -5", overrides),
              "scene.toml:3:7: error: fps must be from 1e-09 to 1000000 frames per second (given -5)");
}

}  // namespace
}  // namespace tumble::overrides_test
