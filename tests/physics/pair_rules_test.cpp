// Restitution and friction of a pair: bodies with a value each by the rule of the scene; a fixed or kinematic body
// without one takes that of the other body.
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace tumble::pair_rules_test {
using namespace tumble::testing;

namespace {

constexpr PairRule rules[] = {PairRule::average, PairRule::minimum, PairRule::multiply, PairRule::maximum,
                              PairRule::geometric};

double expected(PairRule rule, double a, double b) {
    switch (rule) {
        case PairRule::average:
            return (a + b) / 2.0;
        case PairRule::minimum:
            return a < b ? a : b;
        case PairRule::multiply:
            return a * b;
        case PairRule::maximum:
            return a < b ? b : a;
        case PairRule::geometric:
            return std::sqrt(a * b);
    }
    return -1.0;
}

struct Surfaces {
    std::optional<double> floor, body;
    PairRules rules;
    BodyType type = BodyType::fixed;  // of the floor
};

/// e of a box that falls flat on the floor at 4 m/s.
double measured_restitution(const Surfaces& s, ImpactMode impacts, SimulationMethod method) {
    SceneDescription scene = ground_scene(0.0, 0.0);
    scene.simulation.gravity.setZero();
    scene.simulation.impacts = impacts;
    scene.simulation.method = method;
    scene.contact = s.rules;
    scene.bodies[0].type = s.type;
    scene.bodies[0].restitution = s.floor;
    BodyDescription& ball = add_sphere(scene, 0.5, Vec3(0.0, 0.75, 0.0));
    ball.restitution = s.body;
    ball.velocity = Vec3(0.0, -4.0, 0.0);
    World world(scene);
    run(world, scene, 0.25);
    return world.snapshot().bodies[1].velocity.y() / 4.0;
}

/// mu of a box that slides on the floor, by its loss of speed in 0.5 s.
double measured_friction(const Surfaces& s, ContactSolverChoice solver, ImpactMode impacts) {
    SceneDescription scene = ground_scene(0.0, 0.0);
    scene.simulation.contact_solver = solver;
    scene.simulation.impacts = impacts;
    scene.contact = s.rules;
    scene.bodies[0].type = s.type;
    scene.bodies[0].friction = s.floor;
    BodyDescription& box = add_box(scene, Vec3(1.0, 0.2, 1.0), Vec3(0.0, 0.1, 0.0));
    box.friction = s.body;
    box.velocity = Vec3(6.0, 0.0, 0.0);
    World world(scene);
    run(world, scene, 0.5);
    return (6.0 - world.snapshot().bodies[1].velocity.x()) / (9.81 * 0.5);
}

}  // namespace

TEST(PairRules, RestitutionByEachRuleAndMode) {
    for (const PairRule rule : rules)
        for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
            SCOPED_TRACE(int(rule));
            const Surfaces s{0.3, 0.8, {rule, PairRule::geometric}};
            EXPECT_NEAR(measured_restitution(s, mode, SimulationMethod::tumble), expected(rule, 0.3, 0.8), 1e-9);
            EXPECT_NEAR(measured_restitution({0.8, 0.3, s.rules}, mode, SimulationMethod::tumble),
                        expected(rule, 0.3, 0.8), 1e-9);
        }
    const Surfaces notes{0.3, 0.8, {PairRule::multiply, PairRule::geometric}};
    EXPECT_NEAR(measured_restitution(notes, ImpactMode::stepped, SimulationMethod::notes), 0.24, 1e-9);
}

TEST(PairRules, FrictionByEachRuleAndSolver) {
    for (const PairRule rule : rules)
        for (const ContactSolverChoice solver : {ContactSolverChoice::direct, ContactSolverChoice::soft}) {
            SCOPED_TRACE(int(rule));
            const Surfaces s{0.2, 0.5, {PairRule::maximum, rule}};
            EXPECT_NEAR(measured_friction(s, solver, ImpactMode::stepped), expected(rule, 0.2, 0.5), 2e-3);
        }
}

TEST(PairRules, AFloorWithoutValuesTakesThoseOfTheBody) {
    for (const BodyType type : {BodyType::fixed, BodyType::kinematic})
        for (const PairRule rule : rules) {
            SCOPED_TRACE(int(rule));
            const PairRules both{rule, rule};
            for (const double value : {0.0, 0.2, 0.8}) {
                const Surfaces s{std::nullopt, value, both, type};
                for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact})
                    EXPECT_NEAR(measured_restitution(s, mode, SimulationMethod::tumble), value, 1e-9);
                EXPECT_NEAR(measured_friction(s, ContactSolverChoice::soft, ImpactMode::stepped), value, 2e-3);
                EXPECT_NEAR(measured_friction(s, ContactSolverChoice::direct, ImpactMode::exact), value, 2e-3);
            }
        }
}

// Without any values: those of a dynamic body.
TEST(PairRules, WithoutValues) {
    const Surfaces none{std::nullopt, std::nullopt, {}};
    EXPECT_NEAR(measured_restitution(none, ImpactMode::stepped, SimulationMethod::tumble), 0.5, 1e-9);
    EXPECT_NEAR(measured_friction(none, ContactSolverChoice::soft, ImpactMode::stepped), 0.0, 1e-9);
    const Surfaces of_floor{0.9, std::nullopt, {}};
    EXPECT_NEAR(measured_restitution(of_floor, ImpactMode::exact, SimulationMethod::tumble), 0.9, 1e-9);
}

}  // namespace tumble::pair_rules_test
