// Reading of plans: values, defaults, and the form of fixed values. Errors are in tests/cli/sweep_test.py.
#include "app/sweep/sweep_plan.h"

#include "support/folder.h"

#include <gtest/gtest.h>

namespace tumble::sweep_plan_test {
namespace {

SweepPlan plan_of(const std::string& text) {
    const TestFolder folder;
    write_text(folder / "plan.toml", "format = 1\nscene = \"scenes/a.toml\"\n" + text);
    SweepPlan plan = read_plan(folder / "plan.toml");
    plan.scene = plan.scene.lexically_relative(folder.path());
    return plan;
}

std::vector<std::string> list_of(const std::string& keys) {
    const SweepPlan plan = plan_of("[[axis]]\npath = \"a.b\"\n" + keys);
    return std::get<ValueList>(plan.axes.front().source).values;
}

TEST(SweepPlan, ASceneAloneIsOneSample) {
    const SweepPlan plan = plan_of("");
    EXPECT_EQ(plan.samples, 1);
    EXPECT_EQ(plan.scene, "scenes/a.toml");
    EXPECT_EQ(plan.name, "{index:06}");
    EXPECT_EQ(plan.outputs.scene, SceneForm::toml);
    EXPECT_FALSE(plan.outputs.drawn());
}

TEST(SweepPlan, FixedValuesOfDottedAndQuotedKeys) {
    EXPECT_EQ(plan_of("[set]\nsimulation.duration = 2\n\"body.crate.mass\" = 2.5\nlight = { shadows = false }\n").fixed,
              (std::vector<std::string>{"simulation.duration=2", "body.crate.mass=2.5", "light={ shadows = false }"}));
}

TEST(SweepPlan, SizesOfCombinations) {
    const std::string axes = "[[axis]]\npath = \"a\"\nvalues = [1, 2]\n[[axis]]\npath = \"b\"\nvalues = [1, 2]\n";
    EXPECT_EQ(plan_of(axes).samples, 4);
    EXPECT_EQ(plan_of("combine = \"zip\"\n" + axes).samples, 2);
    EXPECT_EQ(plan_of(axes + "[pair]\ndiffer = \"a\"\n").samples, 8);
    EXPECT_EQ(plan_of("samples = 10\n" + axes).samples, 10);
}

TEST(SweepPlan, Ranges) {
    using Values = std::vector<std::string>;
    EXPECT_EQ(list_of("range = { from = 1, to = 7, step = 3 }\n"), (Values{"1", "4", "7"}));
    EXPECT_EQ(list_of("range = { from = 0.0, to = 0.35, step = 0.1 }\n"), (Values{"0.0", "0.1", "0.2", "0.3"}));
    EXPECT_EQ(list_of("range = { from = 3, to = 1, step = -1 }\n"), (Values{"3", "2", "1"}));
    EXPECT_EQ(list_of("range = { from = 0, to = 1, count = 3 }\n"), (Values{"0.0", "0.5", "1.0"}));
    EXPECT_EQ(list_of("range = { from = 2, to = 3, count = 1 }\n"), (Values{"2.0"}));
    const Values log = list_of("range = { from = 0.1, to = 10, count = 3, scale = \"log\" }\n");
    EXPECT_EQ(log.front(), "0.1");
    EXPECT_NEAR(std::stod(log[1]), 1.0, 1e-15);
    EXPECT_EQ(log.back(), "10.0");
}

TEST(SweepPlan, ValuesOfAnyKind) {
    EXPECT_EQ(list_of("values = [true, \"a\\\"b\", [1, 2.5], { x = 1 }]\n"),
              (std::vector<std::string>{"true", "\"a\\\"b\"", "[1, 2.5]", "{ x = 1 }"}));
}

TEST(SweepPlan, OutputsAndDrawing) {
    const SweepPlan plan = plan_of(
        "[outputs]\nclip = \"c.webm\"\naov = \"all\"\ntables = [\"loads\", \"energy\"]\n"
        "table_format = \"npz\"\nscene = \"json\"\n[render]\nspeed = 0.5\ngl = \"egl\"\n"
        "quality = \"best\"\ntransparent = true\n");
    for (const Aov aov : all_aovs) EXPECT_TRUE(plan.outputs.aovs.has(aov));
    EXPECT_TRUE(plan.outputs.loads && plan.outputs.energy && plan.outputs.arrays && !plan.outputs.trajectory);
    EXPECT_EQ(plan.outputs.scene, SceneForm::json);
    EXPECT_EQ(plan.outputs.clip, "c.webm");
    EXPECT_EQ(plan.drawing.speed, 0.5);
    EXPECT_EQ(plan.drawing.backend, GlBackend::egl);
    EXPECT_EQ(plan.drawing.quality, VideoQuality::best);
    EXPECT_TRUE(plan.drawing.transparent);
}

}  // namespace
}  // namespace tumble::sweep_plan_test
