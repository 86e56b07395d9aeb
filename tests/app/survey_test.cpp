// The survey sees the frames of the clip; plotted runs and their labels.
#include "app/plots/plotted_run.h"
#include "app/plots/variants.h"
#include "sim/frames/clip_timing.h"

#include <gtest/gtest.h>

namespace tumble::survey_test {
namespace {

SceneDescription falling_ball() {
    SceneDescription scene;
    scene.output.fps = 10.0;
    BodyDescription ball;
    ball.name = "ball";
    ball.shape = SphereShape{0.5};
    ball.position = {0.0, 10.0, 0.0};
    scene.bodies = {ball};
    scene.simulation.integrator = IntegratorKind::exact;
    return scene;
}

// Free fall: y = 10 - g t^2 / 2, |v| = g t; kinetic and potential energy sum to a constant.
TEST(Survey, ShowsEachFrameOfTheClipToAllObservers) {
    const SceneDescription scene = falling_ball();
    for (const int intervals : {1, 4}) {
        PlottedRun heights("a", parse_quantities("body.ball.y,body.ball.speed", scene));
        PlottedRun energies("b", parse_quantities("total", scene));
        SurveyObserver* const observers[] = {&heights, &energies};
        World world(scene, divided(scene.timing(), intervals), 1);
        Interrupt interrupt;
        survey(world, {11, intervals}, observers, interrupt);
        ASSERT_EQ(heights.times.size(), 11u);
        for (std::size_t n = 0; n < 11; ++n) {
            const double t = double(n) / 10.0;
            EXPECT_DOUBLE_EQ(heights.times[n], t);
            EXPECT_NEAR(heights.values[0][n], 10.0 - 0.5 * 9.81 * t * t, 1e-12);
            EXPECT_NEAR(heights.values[1][n], 9.81 * t, 1e-12);
            EXPECT_NEAR(energies.values[0][n], energies.values[0][0], 1e-9);
        }
        EXPECT_GT(energies.values[0][0], 1.0);
    }
}

struct ImpactCounter : SurveyObserver {
    void see(const Snapshot&, const Survey&, const ContactRecords* records) override {
        impacts += records->impacts.size();
    }
    std::size_t impacts = 0;
};

TEST(Survey, ShowsTheImpactsOfAllIntervalsOfTheShutter) {
    SceneDescription scene = falling_ball();
    scene.bodies[0].position.y() = 1.0;
    scene.bodies[0].restitution = 1.0;
    scene.bodies.emplace_back();
    scene.bodies[1].type = BodyType::fixed;
    scene.bodies[1].shape = PlaneShape{};
    scene.simulation.impacts = ImpactMode::exact;
    for (const int intervals : {1, 4}) {
        ImpactCounter counter;
        SurveyObserver* const observers[] = {&counter};
        World world(scene, divided(scene.timing(), intervals), 1);
        world.record_contacts();
        Interrupt interrupt;
        survey(world, {21, intervals}, observers, interrupt);
        EXPECT_EQ(counter.impacts, 3u);  // at sqrt(2 h / g) (1 + 2 k) = 0.32, 0.96 and 1.60 s, h = 0.5 m
    }
}

// A rod on a hinge, from the horizontal: m g/(1 + m r^2/I) at the start, m g (1 + 2 m r^2/I_A) below the hinge.
TEST(Survey, ShowsTheForceOfAJoint) {
    SceneDescription scene;
    scene.output.fps = 1000.0;
    scene.simulation.integrator = IntegratorKind::exact;
    BodyDescription rod;
    rod.name = "rod.1";
    rod.shape = BoxShape{{1.0, 0.1, 0.1}};
    rod.mass = 2.0;
    rod.position = {0.5, 0.0, 0.0};
    scene.bodies = {rod};
    JointDescription hinge;
    hinge.name = "hinge.a";
    hinge.type = JointType::hinge;
    hinge.second = 0;
    hinge.anchor_second = {-0.5, 0.0, 0.0};
    hinge.frame_first = hinge.frame_second = Quat::FromTwoVectors(Vec3::UnitX(), Vec3::UnitZ());
    hinge.turn[0].motion = JointAxis::Motion::free;
    scene.joints = {hinge};

    PlottedRun run("", parse_quantities("joint.hinge.a.force,joint.hinge.a.turn_x,joint.hinge.a.gap", scene));
    EXPECT_TRUE(run.needs().joints);
    EXPECT_FALSE(run.needs().measurement);
    SurveyObserver* const observers[] = {&run};
    World world(scene, 1);
    Interrupt interrupt;
    survey(world, {601, 1}, observers, interrupt);
    const double weight = 2.0 * 9.81, inertia = 2.0 * 1.01 / 12.0, about_hinge = inertia + 2.0 * 0.25;
    EXPECT_NEAR(run.values[0][0], weight / (1.0 + 0.5 / inertia), 1e-3);
    EXPECT_NEAR(std::ranges::max(run.values[0]), weight * (1.0 + 1.0 / about_hinge), 1e-3);
    EXPECT_LT(run.values[1].back(), -1.5);
    EXPECT_LT(std::ranges::max(run.values[2]), 1e-14);
    EXPECT_EQ(make_panels(std::span(&run, 1), false)[0].series[0].label, "hinge.a");
    EXPECT_THROW(parse_quantities("joint.hinge.a.turn_y", scene), InputError);
}

TEST(Survey, PlotsHaveAPanelForEachUnitAndASeriesForEachRun) {
    const SceneDescription scene = falling_ball();
    const auto quantities = parse_quantities("energy,body.ball.y", scene);
    EXPECT_EQ(panels_of(quantities), 2u);
    const std::vector<PlottedRun> runs{{"one", quantities}, {"two", quantities}};
    const std::vector<Panel> panels = make_panels(runs, true);
    ASSERT_EQ(panels.size(), 2u);
    EXPECT_EQ(panels[0].series.size(), 6u);
    EXPECT_EQ(panels[0].series[1].label, "kinetic, two");
    EXPECT_EQ(panels[1].series[1].label, "two");
}

TEST(Variants, LabelsTellTheRunsApart) {
    const auto labels = [](const std::vector<std::filesystem::path>& scenes, const std::vector<std::string>& vary) {
        std::vector<std::string> all;
        for (const Variant& variant : make_variants(scenes, {}, vary)) all.push_back(variant.label);
        return all;
    };
    using Labels = std::vector<std::string>;
    EXPECT_EQ(labels({"a.toml"}, {}), Labels{""});
    EXPECT_EQ(labels({"a.toml", "x/b.toml"}, {}), (Labels{"a", "b"}));
    EXPECT_EQ(labels({"x/a.toml", "y/a.toml"}, {}), (Labels{"x/a", "y/a"}));
    EXPECT_EQ(labels({"a.toml"}, {"simulation.integrator=rk4,exact"}), (Labels{"rk4", "exact"}));
    EXPECT_EQ(labels({"a.toml"}, {"simulation.sleep=true,false"}), (Labels{"sleep true", "sleep false"}));
    EXPECT_EQ(labels({"a.toml"}, {"body.ball.restitution=0.5,1"}), (Labels{"restitution 0.5", "restitution 1"}));
}

}  // namespace
}  // namespace tumble::survey_test
