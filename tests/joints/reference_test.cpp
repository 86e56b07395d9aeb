// Jointed mechanisms against closed forms and references of 20 digits: tops, four-bars, Bricard's mechanism, struck
// rods.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::reference_test {
using namespace tumble::testing;

namespace {

using std::numbers::pi;

double energy_of(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

/// A box 0.2 x 0.1 x 0.2 m of 1 kg on a ball joint to the world, on its axis y, 0.1 m from its center; leaning from up.
SceneDescription top_scene(double lean, const Vec3& omega, int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.sleep = false;
    scene.simulation.integrator = IntegratorKind::exact;
    const Quat q = turn(Vec3::UnitZ(), -lean);
    const Vec3 e = q * Vec3::UnitY();
    BodyDescription& box = add_box(scene, {0.2, 0.1, 0.2}, 0.1 * e);
    box.rotation = q;
    box.angular_velocity = omega;
    box.velocity = omega.cross(0.1 * e);
    add_joint(scene, JointType::ball, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY());
    return scene;
}

/// Angle from up of the box's axis.
double lean_of(const World& world) {
    const Vec3 e = world.snapshot().bodies[0].orientation * Vec3::UnitY();
    return std::atan2(std::hypot(e.x(), e.z()), e.y());
}

// Spherical pendulum, 120 degrees from up, azimuth rate 4 rad/s: the other turning angle 159.34712544119114 degrees,
// half the period of 0.405923390506001434 s later.
TEST(JointReference, ASphericalPendulum) {
    const double lean = 120.0 * pi / 180.0;
    const Vec3 e(std::sin(lean), std::cos(lean), 0.0);
    SceneDescription scene = top_scene(lean, 4.0 * (Vec3::UnitY() - std::cos(lean) * e), 8);
    scene.output.fps = 1.0 / (0.5 * 0.405923390506001434);  // a frame in half a period
    scene.simulation.steps_per_frame = 100;
    World world(scene);
    const double start = energy_of(world);
    world.advance_frame();
    EXPECT_NEAR(lean_of(world) * 180.0 / pi, 159.34712544119114, 1e-9);
    world.advance_frame();
    EXPECT_NEAR(lean_of(world), lean, 1e-11);
    EXPECT_NEAR(energy_of(world), start, 1e-12);
}

// Lagrange's top with cusps, 30 degrees from up, spin 60 rad/s: lowest lean 36.4057298110046825 degrees, at half of the
// nutation period of 0.26316142503658788 s; precession 0.698304010919854458 rad a nutation.
TEST(JointReference, ALagrangeTopWithCusps) {
    const double lean = pi / 6.0;
    const Vec3 e(std::sin(lean), std::cos(lean), 0.0);
    SceneDescription scene = top_scene(lean, 60.0 * e, 8);
    scene.output.fps = 1.0 / (0.5 * 0.26316142503658788);
    scene.simulation.steps_per_frame = 200;
    World world(scene);
    world.advance_frame();
    EXPECT_NEAR(lean_of(world) * 180.0 / pi, 36.4057298110046825, 1e-8);
    world.advance_frame();
    EXPECT_NEAR(lean_of(world), lean, 1e-10);
    const Vec3 now = world.snapshot().bodies[0].orientation * Vec3::UnitY();
    EXPECT_NEAR(std::abs(std::atan2(now.z(), now.x())), 0.698304010919854458, 1e-9);
    EXPECT_LT(largest_gap(world), 1e-14);
}

/// N + 1 upright cranks of 1 m and N couplers, thin rods of 1 kg; the joint B0 at the top of the first has 1 m/s.
SceneDescription four_bar_scene(int couplers, int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.sleep = false;
    // A thin rod: the inertia of a box of no thickness is m l^2 / 12.
    const Vec3 rod{1.0, 1e-3, 1e-3};
    const double mass = 1.0;
    for (int i = 0; i <= couplers; ++i) {
        BodyDescription& crank = add_box(scene, rod, {double(i), 0.5, 0.01 * i}, mass);  // rods pass each other
        crank.rotation = turn(Vec3::UnitZ(), 0.5 * pi);
        crank.velocity = {0.5, 0.0, 0.0};
        crank.angular_velocity = {0.0, 0.0, -1.0};
        add_joint(scene, JointType::hinge, std::nullopt, std::size_t(i), {double(i), 0.0, 0.0}, Vec3::UnitZ());
    }
    for (int i = 0; i < couplers; ++i) {
        BodyDescription& coupler = add_box(scene, rod, {i + 0.5, 1.0, 0.1 + 0.01 * i}, mass);
        coupler.velocity = {1.0, 0.0, 0.0};
        const std::size_t body = scene.bodies.size() - 1;
        add_joint(scene, JointType::hinge, std::size_t(i), body, {double(i), 1.0, 0.0}, Vec3::UnitZ());
        add_joint(scene, JointType::hinge, std::size_t(i + 1), body, {i + 1.0, 1.0, 0.0}, Vec3::UnitZ());
    }
    return scene;
}

// IFToMM's benchmark A02: the cranks lie flat twice a turn, where the mechanism is singular.
TEST(JointReference, AFourBarPassesItsSingularPosition) {
    SceneDescription scene = four_bar_scene(2, 4);
    scene.simulation.integrator = IntegratorKind::runge_kutta_4;
    World world(scene);
    const double start = energy_of(world);
    double gap = 0.0, energy = 0.0;
    for (int frame = 0; frame < 600; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        energy = std::max(energy, std::abs(energy_of(world) - start));
    }
    const BodyState crank = world.snapshot().bodies[0];
    const Vec3 b0 = crank.origin + crank.orientation * Vec3(0.5, 0.0, 0.0);
    EXPECT_NEAR(b0.x(), 0.328458111540815379, 1e-3);
    EXPECT_NEAR(b0.y(), 0.944538518178600962, 1e-3);
    EXPECT_LT(gap, 1e-5);
}

// IFToMM's benchmark A04: Bricard's mechanism of six hinges, one more than it needs.
TEST(JointReference, BricardsMechanism) {
    const Vec3 corners[6] = {{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
    const Vec3 axes[6] = {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
    SceneDescription scene;
    scene.simulation.steps_per_frame = 2;
    scene.simulation.sleep = false;
    scene.simulation.integrator = IntegratorKind::exact;
    for (int i = 0; i < 5; ++i) {
        const Vec3 along = (corners[i + 1] - corners[i]).cwiseAbs();
        add_box(scene, along.cwiseMax(0.1), 0.5 * (corners[i] + corners[i + 1]));
    }
    for (int i = 0; i < 6; ++i) {
        const auto first = i == 0 ? std::nullopt : std::optional<std::size_t>(i - 1);
        const auto second = i == 5 ? std::nullopt : std::optional<std::size_t>(i);
        add_joint(scene, JointType::hinge, first, second, corners[i], axes[i]);
    }
    World world(scene);
    const double start = energy_of(world);
    run(world, scene, 1.0);
    const BodyState link = world.snapshot().bodies[2];
    const Vec3 corner = link.origin + link.orientation * Vec3(0.0, 0.0, 0.5);
    EXPECT_LT((corner - Vec3(0.5105014611872, -1.6491675993948, 0.1401231145532)).norm(), 1e-9);
    EXPECT_NEAR(energy_of(world), start, 1e-8);
    EXPECT_LT(largest_gap(world), 1e-13);
}

// n free rods of 1 m and 1 kg in a row with hinges, at rest; a unit impulse across the end of the first.
TEST(JointReference, StruckRods) {
    const std::vector<std::vector<std::pair<double, double>>> after = {
        {{5.0 / 4, -9.0 / 2}, {-1.0 / 4, 3.0 / 2}},
        {{19.0 / 15, -22.0 / 5}, {-1.0 / 3, 6.0 / 5}, {1.0 / 15, -2.0 / 5}},
        {{71.0 / 56, -123.0 / 28}, {-19.0 / 56, 33.0 / 28}, {5.0 / 56, -9.0 / 28}, {-1.0 / 56, 3.0 / 28}}};
    for (std::size_t n = 2; n <= 4; ++n) {
        SceneDescription scene = empty_scene();
        scene.output.fps = 1e9;  // a nanosecond of force: the rods have not turned
        scene.simulation.steps_per_frame = 1;
        for (std::size_t i = 0; i < n; ++i) {
            add_box(scene, {1.0, 1e-4, 1e-4}, {double(i), 0.0, 0.0});
            if (i > 0) add_joint(scene, JointType::hinge, i - 1, i, {double(i) - 0.5, 0.0, 0.0}, Vec3::UnitZ());
        }
        ForceDescription force;
        force.body = 0;
        force.point = {-0.5, 0.0, 0.0};
        force.force = {0.0, 1e9, 0.0};
        force.end = 1e-9;
        scene.forces.push_back(force);
        World world(scene);
        world.step();
        double worst = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            const BodyState body = world.snapshot().bodies[i];
            worst = std::max({worst, std::abs(body.velocity.y() - after[n - 2][i].first),
                              std::abs(body.angular_velocity.z() - after[n - 2][i].second)});
        }
        EXPECT_LT(worst, 1e-7);
    }
}

// A rod that hangs on a hinge, struck at its center of percussion: the hinge feels nothing.
TEST(JointReference, CenterOfPercussion) {
    SceneDescription scene = pendulum_scene(0.0);
    scene.simulation.gravity = Vec3::Zero();
    scene.output.fps = 1e6;
    scene.simulation.steps_per_frame = 1;
    ForceDescription force;
    force.body = 0;
    force.point = {1.01 / 12.0 / 0.5 + 0.5 - 0.5, 0.0, 0.0};  // I_O / (m l) = 0.668333... m from the hinge
    force.force = {0.0, 1.0, 0.0};
    force.body_frame = true;
    scene.forces.push_back(force);
    scene.forces.back().end = infinity;
    World world(scene);
    world.step();
    EXPECT_LT(world.joint_states()[0].force.norm(), 1e-9);
}

}  // namespace
}  // namespace tumble::reference_test
