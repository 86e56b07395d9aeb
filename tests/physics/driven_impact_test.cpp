// Event-driven mode: impacts of bodies under forces that have no closed form, as forces between bodies and explosions.
#include "exact_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::driven_impact_test {
using namespace tumble::testing;

namespace {

SceneDescription space() {
    SceneDescription scene = empty_scene(1);
    make_exact(scene);
    scene.simulation.sleep = false;
    return scene;
}

const Vec3& position(const Snapshot& snapshot, std::size_t body) { return snapshot.bodies[body].center_of_mass; }

double total(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential + m.elastic;
}

/// Time (s) in which two bodies at rest at the distance d fall to the distance s; mu = G (m1 + m2).
double fall_time(double d, double s, double mu) {
    const double x = s / d;
    return std::sqrt(d * d * d / (2.0 * mu)) * (std::sqrt(x * (1.0 - x)) + std::acos(std::sqrt(x)));
}

// After each bounce without a loss, bodies that attract are at rest at their first distance again.
TEST(DrivenImpacts, BodiesThatAttractBounceAndReturn) {
    constexpr double first = 2.0, second = 5.0, radius = 0.1, distance = 1.5, strength = 0.7;
    const Vec3 along = Vec3(2.0, -1.0, 0.5).normalized(), drift(0.3, 0.1, -0.2), start(0.4, 0.2, -0.1);
    SceneDescription scene = space();
    const double time = fall_time(distance, 2.0 * radius, strength * (first + second));
    scene.output.fps = 7.3 / time;  // impacts are within steps
    for (const double side : {1.0, -1.0}) {
        const double share = side > 0.0 ? second / (first + second) : first / (first + second);
        BodyDescription& ball =
            add_sphere(scene, radius, start + side * share * distance * along, side > 0.0 ? first : second);
        ball.velocity = drift;
        ball.restitution = 1.0;
    }
    add_pair_force(scene, PairForceKind::gravity, strength, {0, 1});
    World world(scene);
    world.record_energy();
    const double energy = total(world);
    const Vec3 momentum = world.measure().momentum;
    for (int n = 1; n <= 146; ++n) {
        world.advance_frame();
        EXPECT_NEAR(total(world), energy, 1e-9) << n;
        EXPECT_LT((world.measure().momentum - momentum).norm(), 1e-13);
        EXPECT_NEAR(world.contact_records().energy.work, 0.0, 1e-9);
        if (n != 73 && n != 146) continue;  // five and ten bounces
        const Snapshot there = world.snapshot();
        EXPECT_NEAR((position(there, 0) - position(there, 1)).norm(), distance, 1e-7);
        EXPECT_LT((there.bodies[0].velocity - drift).norm(), 1e-6);
        EXPECT_LT((position(there, 0) - position(there, 1)).normalized().cross(along).norm(), 1e-7);
    }
}

// A wall turns one of two bodies that circle each other: the other one feels it at once.
TEST(DrivenImpacts, AnImpactOfOneChangesTheFlightOfAll) {
    const auto run_with = [](ImpactMode mode, int steps) {
        SceneDescription scene = space();
        scene.simulation.impacts = mode;
        scene.simulation.steps_per_frame = steps;
        for (const double side : {1.0, -1.0}) {
            BodyDescription& ball = add_sphere(scene, 0.1, {side, 0.0, 0.0}, 1.0);
            ball.velocity = {0.0, 0.6 * side, 0.1};
            ball.restitution = 1.0;
        }
        add_sphere(scene, 0.1, {0.0, 3.0, 0.5}, 0.5);
        add_fixed_box(scene, {3.0, 0.2, 3.0}, {0.0, -0.83, 0.0}, 1.0);
        add_pair_force(scene, PairForceKind::inverse_square, 1.0, {0, 1, 2});
        World world(scene);
        const double energy = total(world);
        run(world, scene, 1.6);
        if (mode == ImpactMode::exact) {
            EXPECT_NEAR(total(world), energy, 1e-8);
        }
        return world.snapshot();
    };
    const Snapshot coarse = run_with(ImpactMode::exact, 1), fine = run_with(ImpactMode::exact, 64),
                   stepped = run_with(ImpactMode::stepped, 2048);
    EXPECT_GT(fine.bodies[1].velocity.y(), 0.0);  // it has bounced
    for (const std::size_t body : {0, 1, 2}) {
        EXPECT_LT((position(coarse, body) - position(fine, body)).norm(), 1e-7) << body;
        EXPECT_LT((position(stepped, body) - position(fine, body)).norm(), 1e-3) << body;
    }
}

// Without weight, attraction alone holds balls together, and repulsion alone parts them.
TEST(DrivenImpacts, AttractionHoldsAndRepulsionParts) {
    SceneDescription scene = space();
    for (const double side : {1.0, -1.0}) {
        BodyDescription& ball = add_sphere(scene, 0.1, {0.3 * side, 0.0, 0.0}, 1.0);
        ball.restitution = 0.3;
    }
    add_pair_force(scene, PairForceKind::inverse_square, 0.5, {0, 1}).end = 2.0;
    PairForceDescription& repulsion = add_pair_force(scene, PairForceKind::coulomb, 0.5, {0, 1});
    repulsion.charges = {1.0, 1.0};
    repulsion.start = 2.5;
    World world(scene);
    run(world, scene, 1.9);
    const Snapshot held = world.snapshot();
    EXPECT_NEAR((position(held, 0) - position(held, 1)).norm(), 0.2, 1e-6);
    EXPECT_LT(held.bodies[0].velocity.norm(), 1e-6);
    run(world, scene, 0.6);
    EXPECT_LT((position(world.snapshot(), 0) - position(held, 0)).norm(), 1e-5);
    run(world, scene, 0.5);
    // Energy of the repulsion from the contact on: v^2 = k (1 / 0.2 - 1 / d) for each ball of 1 kg.
    const Snapshot parted = world.snapshot();
    const double d = (position(parted, 0) - position(parted, 1)).norm();
    EXPECT_GT(d, 0.5);
    EXPECT_NEAR(parted.bodies[0].velocity.norm(), std::sqrt(0.5 * (1.0 / 0.2 - 1.0 / d)), 1e-4);
    EXPECT_LT(world.measure().momentum.norm(), 1e-13);
}

// Magnets in a row, turned against each other, come together. While some are in contact and others fly, momentum is
// kept to first order in the step.
TEST(DrivenImpacts, MagnetsComeTogether) {
    SceneDescription scene = space();
    scene.simulation.steps_per_frame = 16;
    for (int i = 0; i < 3; ++i) {
        BodyDescription& magnet = add_box(scene, {0.1, 0.1, 0.2}, {0.0, 0.01 * i, 0.5 * i}, 1.0);
        magnet.rotation = turn(Vec3::UnitX(), 0.3 * i);
        magnet.restitution = 0.2;
    }
    add_pair_force(scene, PairForceKind::dipole, 1e-7, {0, 1, 2}).moments = {3, {0.0, 0.0, 400.0}};
    World world(scene);
    world.record_energy();
    const double energy = total(world);
    double lost = 0.0;
    for (int n = 0; n < 240; ++n) {
        world.advance_frame();
        const EnergyLedger& books = world.contact_records().energy;
        EXPECT_GE(books.impact_loss, lost - 1e-9);
        lost = books.impact_loss;
    }
    EXPECT_LT(world.measure().momentum.norm(), 0.05);
    const Snapshot end = world.snapshot();
    EXPECT_LT(position(end, 2).z() - position(end, 0).z(), 0.6);
    EXPECT_LT(total(world), energy);
}

// I / 64 each from below, in the middle of a flight in closed form and at rest; impacts after it have their own times.
TEST(DrivenImpacts, AnExplosionEndsAFlightInClosedForm) {
    constexpr double impulse = 12.0, time = 0.4013;
    SceneDescription scene = space();
    BodyDescription& flying = add_sphere(scene, 0.5, {0.0, 2.0, 0.0}, 0.1);
    flying.restitution = 1.0;
    add_sphere(scene, 0.5, {0.0, -2.0, 0.0}, 0.1);
    add_fixed_box(scene, {4.0, 1.0, 4.0}, {0.0, 4.0, 0.0}, 1.0);
    scene.explosions.push_back({Vec3::Zero(), time, impulse, infinity});
    World world(scene);
    world.record_energy();
    run(world, scene, 0.4);
    EXPECT_TRUE(world.snapshot().bodies[0].momentum.isZero(0.0));
    run(world, scene, 1.6);
    const Snapshot end = world.snapshot();
    const double speed = impulse / 64.0 / 0.1, h = scene.step();
    const double middle = 0.5 * (std::min(time, 25.0 * h - 0.25 * h) + 25.0 * h);  // its force ends with the step
    EXPECT_NEAR(end.bodies[1].velocity.y(), -speed, 1e-13);
    EXPECT_NEAR(position(end, 1).y(), -2.0 - speed * (2.0 - middle), 1e-12);
    EXPECT_NEAR(end.bodies[0].velocity.y(), -speed, 1e-13);
    EXPECT_NEAR(position(end, 0).y(), 3.0 - (speed * (2.0 - middle) - 1.0), 1e-12);
    EXPECT_NEAR(world.contact_records().energy.work, world.measure().kinetic, 1e-12);
}

// All bodies sleep: no event is left, and the force wakes them nevertheless.
TEST(DrivenImpacts, ForcesThatBeginWakeSleepingBodies) {
    for (const int kind : {0, 1, 2}) {
        SceneDescription scene = ground_scene(0.0, 0.5, 1);
        make_exact(scene);
        scene.simulation.sleep = true;
        for (const double side : {1.0, -1.0}) add_box(scene, {0.4, 0.4, 0.4}, {0.5 * side, 0.2, 0.0});
        if (kind == 0) scene.explosions.push_back({{0.0, 0.2, 0.0}, 3.0, 100.0, infinity});
        if (kind == 1) add_pair_force(scene, PairForceKind::inverse_square, -20.0, {1, 2}).start = 3.0;
        if (kind == 2) {
            FieldDescription field;
            field.type = FieldKind::uniform;
            field.acceleration = {20.0, 0.0, 0.0};
            field.start = 3.0;
            field.end = infinity;
            scene.fields.push_back(field);
        }
        World world(scene);
        run(world, scene, 2.9);
        ASSERT_TRUE(world.snapshot().bodies[1].asleep || kind == 1) << kind;
        run(world, scene, 0.3);
        EXPECT_GT(world.snapshot().bodies[1].velocity.norm(), 0.1) << kind;
    }
}

}  // namespace
}  // namespace tumble::driven_impact_test
