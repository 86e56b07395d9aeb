// A body alone over a span of time: closed forms of drag, thrust and spans of force, and references of higher
// precision.
#include "sim/dynamics/integrators/advance.h"

#include "core/error.h"
#include "sim/dynamics/body_builder.h"
#include "sim/random_shapes.h"
#include "support/motion_reference.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::advance_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

Body built(const SceneDescription& scene) { return BodyBuilder().build(scene.bodies[0], IntegratorKind::exact); }

RigidState exactly(const SceneDescription& scene, double from, double to) {
    return advance_exactly(built(scene), ForceField(scene), 0, from, to);
}

SceneDescription falling_box() {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    BodyDescription& box = add_box(scene, {1.0, 0.6, 0.2}, {1.0, 2.0, 3.0}, 2.0);
    box.rotation = turn({1.0, 2.0, -0.5}, 0.7);
    box.velocity = Vec3(1.0, 5.0, -2.0);
    box.angular_velocity = Vec3(1.0, -2.0, 3.0);
    return scene;
}

ReferenceBody reference_of(const SceneDescription& scene) {
    const Body body = built(scene);
    ReferenceBody r;
    r.mass = body.mass;
    if (scene.wind) r.drag = 0.5L * scene.wind->density * scene.wind->drag * body.drag_area;
    for (int i = 0; i < 3; ++i) {
        const auto n = std::size_t(i);
        r.inertia[n] = body.inertia_body(i, i), r.gravity[n] = scene.simulation.gravity[i];
        if (scene.wind) r.wind[n] = scene.wind->velocity[i];
        r.y[n] = body.position[i], r.y[4 + n] = body.orientation.vec()[i];
        r.y[7 + n] = body.velocity[i], r.y[10 + n] = body.angular_momentum[i];
    }
    r.y[3] = body.orientation.w();
    return r;
}

void act(ReferenceBody& r, const ForceDescription& f) {
    r.force_turns = f.body_frame;
    for (int i = 0; i < 3; ++i) r.point[std::size_t(i)] = f.point[i], r.force[std::size_t(i)] = f.force[i];
}

void expect_near(const RigidState& s, const ReferenceBody& truth, double mass, double allowed) {
    EXPECT_LT((s.position - truth.position()).norm(), allowed * (1.0 + truth.position().norm()));
    EXPECT_LT(truth.angle_to(s.orientation), allowed);
    EXPECT_LT((s.momentum / mass - truth.velocity()).norm(), allowed * (1.0 + truth.velocity().norm()));
    EXPECT_LT((s.angular_momentum - truth.angular_momentum()).norm(),
              allowed * (1.0 + truth.angular_momentum().norm()));
}

}  // namespace

TEST(AdvanceExactly, GravityAloneIsTheParabolaAndFreeRotation) {
    const SceneDescription scene = falling_box();
    const Body body = built(scene);
    const RigidState s = exactly(scene, 0.0, 2.0);
    EXPECT_LT((s.position - Vec3(3.0, 12.0 - 2.0 * g, -1.0)).norm(), 1e-14 * 12.0);
    EXPECT_LT((s.momentum - 2.0 * Vec3(1.0, 5.0 - 2.0 * g, -2.0)).norm(), 1e-14 * 40.0);
    EXPECT_EQ(s.angular_momentum, body.angular_momentum);
    ReferenceBody truth = reference_of(scene);
    truth.advance(2.0, 60000);
    expect_near(s, truth, 2.0, 1e-13);
}

// v = v_t tanh(g t / v_t), height lost v_t^2 / g ln cosh(g t / v_t).
TEST(AdvanceExactly, FallThroughAir) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    scene.wind = WindDescription{Vec3::Zero(), 1.2, 0.47};
    add_sphere(scene, 0.5, {0.0, 0.0, 0.0}, 2.0);
    const Body body = built(scene);
    const double terminal = std::sqrt(2.0 * 2.0 * g / (1.2 * 0.47 * body.drag_area));
    for (const double t : {1e-3, 0.1, 1.0, 5.0, 20.0}) {
        const RigidState s = exactly(scene, 0.0, t);
        const double x = g * t / terminal;
        EXPECT_NEAR(s.momentum.y() / 2.0, -terminal * std::tanh(x), 1e-13 * terminal);
        const double log_cosh = x + std::log1p(std::exp(-2.0 * x)) - std::log(2.0);
        EXPECT_NEAR(s.position.y(), -terminal * terminal / g * log_cosh, 1e-13 * (1.0 + terminal * t));
    }
}

// Thrown straight up, it comes to rest in the air, where drag is not smooth. Up: v = v_t tan((t_top - t) g / v_t).
TEST(AdvanceExactly, ThrownUpThroughAir) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    scene.wind = WindDescription{Vec3::Zero(), 1.2, 0.47};
    add_sphere(scene, 0.1, {0.0, 0.0, 0.0}, 0.05).velocity = Vec3(0.0, 15.0, 0.0);
    const Body body = built(scene);
    const double terminal = std::sqrt(2.0 * 0.05 * g / (1.2 * 0.47 * body.drag_area));
    const double top = terminal / g * std::atan(15.0 / terminal);
    const double height = 0.5 * terminal * terminal / g * std::log1p(15.0 * 15.0 / terminal / terminal);
    for (const double t : {0.5 * top, 0.99 * top, top, 1.5 * top, 3.0 * top}) {
        const RigidState s = exactly(scene, 0.0, t);
        const double x = g * (t - top) / terminal;
        EXPECT_NEAR(s.momentum.y() / 0.05, t < top ? -terminal * std::tan(x) : -terminal * std::tanh(x), 2e-12)
            << t / top;
        const double way = terminal * terminal / g * (t < top ? -std::log(std::cos(x)) : std::log(std::cosh(x)));
        EXPECT_NEAR(s.position.y(), height - way, 2e-12) << t / top;
    }
}

// Drag alone has no torque: any rotation is as exact as without air.
TEST(AdvanceExactly, DragLeavesTheRotationInClosedForm) {
    SceneDescription scene = falling_box();
    scene.bodies[0].angular_velocity = Vec3(3e3, -2e3, 1e3);
    const RigidState free = exactly(scene, 0.0, 3.0);
    scene.wind = WindDescription{Vec3(3.0, 0.0, 1.0), 1.2, 1.0};
    const RigidState s = exactly(scene, 0.0, 3.0);
    EXPECT_EQ(s.orientation.coeffs(), free.orientation.coeffs());
    EXPECT_EQ(s.angular_momentum, free.angular_momentum);
    ReferenceBody truth = reference_of(scene);
    truth.inertia = {1e9, 1e9, 1e9};  // as if it did not rotate: the center is independent of the rotation
    truth.advance(3.0, 60000);
    EXPECT_LT((s.position - truth.position()).norm(), 1e-12);
}

TEST(AdvanceExactly, ForcesAtPointsAgainstTheReference) {
    Random random(51);
    for (int i = 0; i < trials(20); ++i) {
        SceneDescription scene = falling_box();
        if (i % 2) scene.wind = WindDescription{random.vector(5.0), 1.2, random(0.1, 1.0)};
        scene.forces.push_back({0, random.vector(0.5), random.vector(4.0), i % 3 == 0, -1.0, 10.0});
        ReferenceBody truth = reference_of(scene);
        act(truth, scene.forces[0]);
        truth.advance(1.0, 20000);
        expect_near(exactly(scene, 0.0, 1.0), truth, 2.0, 2e-13);
    }
}

// A thruster on the rim of a disc that rotates about its axis: angle = tau t^2 / 2 I.
TEST(AdvanceExactly, ConstantTorqueAboutAPrincipalAxis) {
    SceneDescription scene = empty_scene();
    add_box(scene, {1.0, 1.0, 0.2}, Vec3::Zero(), 3.0);
    scene.forces.push_back({0, Vec3(0.5, 0.0, 0.0), Vec3(0.0, 2.0, 0.0), true, 0.0, 100.0});
    const double inertia = 3.0 * 2.0 / 12.0, t = 8.0;
    const RigidState s = exactly(scene, 0.0, t);
    EXPECT_NEAR(s.angular_momentum.z(), t, 1e-13);
    EXPECT_LT(s.orientation.angularDistance(turn(Vec3::UnitZ(), std::remainder(0.5 * t * t / inertia, 2.0 * M_PI))),
              1e-12);
}

// Forces begin and end anywhere within the span: the result is the sum over the spans between them.
TEST(AdvanceExactly, StepsStopWhereForcesBeginAndEnd) {
    SceneDescription scene = falling_box();
    scene.wind = WindDescription{Vec3(1.0, 0.0, 2.0), 1.2, 0.5};
    scene.forces.push_back({0, Vec3(0.3, 0.1, 0.0), Vec3(2.0, 1.0, 0.0), true, 0.123456, 0.7654321});
    ReferenceBody truth = reference_of(scene);
    truth.advance(0.123456, 5000);
    act(truth, scene.forces[0]);
    truth.advance(0.7654321 - 0.123456, 20000);
    truth.force = {0, 0, 0};
    truth.advance(1.0 - 0.7654321, 8000);
    expect_near(exactly(scene, 0.0, 1.0), truth, 2.0, 1e-13);
    // The same in pieces.
    Body body = built(scene);
    const ForceField forces(scene);
    for (int i = 0; i < 30; ++i) set_state(body, advance_exactly(body, forces, 0, i / 30.0, (i + 1) / 30.0));
    expect_near(state_of(body), truth, 2.0, 1e-12);
}

// The impulse F t of a span that begins and ends within steps.
TEST(AdvanceOneStep, GivesForcesTheirWholeSpan) {
    for (const auto kind : {IntegratorKind::splitting, IntegratorKind::runge_kutta_4}) {
        SceneDescription scene = empty_scene();
        add_box(scene, {1.0, 1.0, 1.0}, Vec3::Zero(), 3.0);
        scene.forces.push_back({0, Vec3::Zero(), Vec3(0.0, 0.0, 6.0), false, 0.111, 0.777});
        const ForceField forces(scene);
        Body body = built(scene);
        for (int i = 0; i < 10; ++i) advance_one_step(body, kind, forces, 0, i / 10.0, (i + 1) / 10.0);
        EXPECT_NEAR(body.momentum.z(), 6.0 * 0.666, 1e-14);
        EXPECT_NEAR(body.position.z(), 0.5 * 2.0 * 0.666 * 0.666 + 2.0 * 0.666 * 0.223, 1e-14);
    }
}

TEST(AdvanceExactly, LightBodiesInThickAir) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    scene.wind = WindDescription{Vec3(10.0, 0.0, 0.0), 1000.0, 1.0};
    add_sphere(scene, 1.0, Vec3::Zero(), 1e-4).velocity = Vec3(0.0, 1e3, 0.0);
    const RigidState s = exactly(scene, 0.0, 1.0 / 60.0);
    // The body immediately moves at the speed of the air, and falls through it at the terminal speed.
    const double terminal = std::sqrt(2.0 * 1e-4 * g / (1000.0 * built(scene).drag_area));
    EXPECT_NEAR(s.momentum.x() / 1e-4, 10.0, 1e-9);
    EXPECT_NEAR(s.momentum.y() / 1e-4, -terminal, 1e-9);
    // A balloon in a medium denser than a star.
    scene.wind->density = 1e30;
    EXPECT_THROW(exactly(scene, 0.0, 1.0 / 60.0), RunError);
}

TEST(ForceField, KnowsWhenOnlyGravityActs) {
    SceneDescription scene = falling_box();
    add_sphere(scene, 1.0, Vec3::Zero());
    scene.forces.push_back({0, Vec3::Zero(), Vec3::UnitX(), false, 1.0, 2.0});
    const ForceField forces(scene);
    EXPECT_TRUE(forces.constant(0, 0.0, 1.0));
    EXPECT_FALSE(forces.constant(0, 0.5, 1.5));
    EXPECT_FALSE(forces.constant(0, 1.2, 1.4));
    EXPECT_FALSE(forces.constant(0, 0.0, 9.0));
    EXPECT_TRUE(forces.constant(0, 2.0, 9.0));
    EXPECT_TRUE(forces.constant(1, 0.0, 9.0));
    EXPECT_EQ(forces.next_change(0, 0.5), 1.0);
    EXPECT_EQ(forces.next_change(0, 1.0), 2.0);
    EXPECT_EQ(forces.next_change(0, 2.0), std::numeric_limits<double>::infinity());
    scene.wind = WindDescription{};
    EXPECT_FALSE(ForceField(scene).constant(1, 0.0, 1.0));
}

}  // namespace tumble::advance_test
