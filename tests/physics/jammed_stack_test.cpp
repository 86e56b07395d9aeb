// A light body that jams between the floor and the foot of a stack: its impulses are a millionth of the stack's, and
// the solution must be found all the same. Each solve that fails drops the whole stack into soft contact for some
// steps.
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::jammed_stack_test {
using namespace tumble::testing;

namespace {

constexpr double h = 1.0 / 960.0, side = 0.5;

SceneDescription stack(int boxes, double friction) {
    SceneDescription scene = ground_scene(0.0, friction, 1);
    scene.output.fps = 1.0 / h;
    for (int i = 0; i < boxes; ++i) {
        BodyDescription& box = add_box(scene, {side, side, side}, {0.0, side * (i + 0.5), 0.0}, 125.0);
        box.friction = friction;
    }
    return scene;
}

/// Rolls at 0.2 m/s towards the foot of the stack.
BodyDescription& add_ball(SceneDescription& scene, double friction, double mass) {
    BodyDescription& ball = add_sphere(scene, 0.1, {-0.37, 0.1, 0.0}, mass);
    ball.friction = friction;
    ball.velocity = {0.2, 0.0, 0.0};
    ball.angular_velocity = {0.0, 0.0, -2.0};
    return ball;
}

struct Outcome {
    double least_load, most_load;  // of the floor in a step, shares of the weight of all
    double most_energy;            // J: kinetic
};

/// The floor's force follows from the momentum of all bodies.
Outcome watch(const SceneDescription& scene, double seconds) {
    World world(scene);
    double mass = 0.0;
    for (const BodyState& body : world.snapshot().bodies) mass += body.mass;
    const double weight = mass * scene.simulation.gravity.norm();
    Outcome outcome{1.0, 1.0, 0.0};
    double before = world.measure().momentum.y();
    for (int step = 0; step < int(std::lround(seconds / h)); ++step) {
        world.advance_frame();
        const Measurement now = world.measure();
        const double load = 1.0 + (now.momentum.y() - before) / (h * weight);
        before = now.momentum.y();
        outcome.least_load = std::min(outcome.least_load, load);
        outcome.most_load = std::max(outcome.most_load, load);
        outcome.most_energy = std::max(outcome.most_energy, now.kinetic);
    }
    return outcome;
}

void expect_carried(const SceneDescription& scene, double seconds, double energy) {
    const Outcome outcome = watch(scene, seconds);
    EXPECT_GT(outcome.least_load, 0.95);
    EXPECT_LT(outcome.most_load, 1.05);
    EXPECT_LT(outcome.most_energy, energy * (1.0 + 1e-9));
}

double kinetic(const SceneDescription& scene) { return World(scene).measure().kinetic; }

}  // namespace

TEST(JammedStack, TheFloorCarriesItInEachStep) {
    for (const double friction : {0.2, 0.3, 0.5, 0.7, 1.0})
        for (const int boxes : {3, 5, 10})
            for (const double mass : {0.01, 1.0}) {
                SCOPED_TRACE(::testing::Message() << boxes << " boxes, friction " << friction << ", " << mass << " kg");
                SceneDescription scene = stack(boxes, friction);
                add_ball(scene, friction, mass);
                expect_carried(scene, 0.3, kinetic(scene));
            }
}

}  // namespace tumble::jammed_stack_test
