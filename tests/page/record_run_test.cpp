// Recorded runs: states at impacts against closed forms.
#include "app/page/record_run.h"

#include <gtest/gtest.h>

#include "support/scenes.h"

#include <cmath>

namespace tumble::record_run_test {
namespace {

SceneDescription dropped_ball(ImpactMode mode) {
    SceneDescription scene = testing::ground_scene(0.5, 0.0);
    testing::add_sphere(scene, 0.25, {0.1, 1.25, 0.0}).velocity = {0.5, 0.0, 0.0};
    scene.simulation.impacts = mode;
    scene.simulation.duration = 0.6;
    return scene;
}

PageRun recorded(SceneDescription scene) {
    scene.camera.eye = {0.0, 2.0, 8.0};  // a scene file has one, or the default
    scene.camera.target = Vec3::Zero();
    Interrupt interrupt;
    return record_run(scene, {}, interrupt);
}

TEST(RecordRun, AnExactImpactHasTheStateOfTheClosedForm) {
    const PageRun run = recorded(dropped_ball(ImpactMode::exact));
    ASSERT_EQ(run.impacts.size(), 1u);
    EXPECT_TRUE(run.bodies[0].events.empty());  // the floor never moves
    ASSERT_EQ(run.bodies[1].events.size(), 1u);
    const double fall = std::sqrt(2.0 / 9.81), speed = std::sqrt(2.0 * 9.81);
    const BodyEvent& event = run.bodies[1].events[0];
    EXPECT_NEAR(event.time, fall, 1e-12);
    EXPECT_LT((event.body.position - Vec3(0.1 + 0.5 * fall, 0.25, 0.0)).norm(), 1e-12);
    EXPECT_LT((event.body.velocity_before - Vec3(0.5, -speed, 0.0)).norm(), 1e-12);
    EXPECT_LT((event.body.velocity_after - Vec3(0.5, 0.5 * speed, 0.0)).norm(), 1e-12);
}

TEST(RecordRun, AnImpactOfAStepIsAtTheStartOfTheStep) {
    const SceneDescription scene = dropped_ball(ImpactMode::stepped);
    const PageRun run = recorded(scene);
    ASSERT_EQ(run.bodies[1].events.size(), 1u);
    const BodyEvent& event = run.bodies[1].events[0];
    EXPECT_NEAR(event.time, run.impacts[0].record.when.time - scene.step(), 1e-15);
    // Symplectic Euler: after n steps the speed is n h g.
    const double steps = event.time / scene.step();
    EXPECT_NEAR(event.body.velocity_before.y(), -9.81 * scene.step() * std::round(steps), 1e-12);
    EXPECT_NEAR(event.body.velocity_after.y(), -0.5 * event.body.velocity_before.y(), 1e-12);
}

TEST(RecordRun, BodiesOfAnImpactOfManyPassesHaveOneStateEach) {
    SceneDescription scene = testing::empty_scene();
    for (int i = 0; i < 4; ++i) {
        BodyDescription& ball = testing::add_sphere(scene, 0.25, {0.5 * i + (i > 0 ? 1.0 : 0.0), 0.0, 0.0});
        ball.restitution = 1.0;
        if (i == 0) ball.velocity = {2.0, 0.0, 0.0};
    }
    scene.simulation.impacts = ImpactMode::exact;
    scene.simulation.duration = 1.0;
    const PageRun run = recorded(scene);
    ASSERT_EQ(run.impacts.size(), 3u);  // the impulse passes from ball to ball
    for (std::size_t i = 0; i < 4; ++i) {
        ASSERT_EQ(run.bodies[i].events.size(), 1u);
        const StruckBody& body = run.bodies[i].events[0].body;
        EXPECT_NEAR(body.velocity_before.x(), i == 0 ? 2.0 : 0.0, 1e-12);
        EXPECT_NEAR(body.velocity_after.x(), i == 3 ? 2.0 : 0.0, 1e-12);
    }
}

}  // namespace
}  // namespace tumble::record_run_test
