// Figures and nets: a quadruped of 18 degrees of freedom after a push, a net of balls, rings that hold each other.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::figures_test {
using namespace tumble::testing;

namespace {

struct Part {
    double mass;
    Vec3 inertia;  // kg m^2, about its center, along x, y, z
    Vec3 center;   // m, from its joint
};

/// A box with the mass and the inertia.
BodyDescription& add_part(SceneDescription& scene, const Part& part, const Vec3& joint) {
    const double sum = part.inertia.sum();
    Vec3 size;
    for (int k = 0; k < 3; ++k) size[k] = std::sqrt(6.0 * (sum - 2.0 * part.inertia[k]) / part.mass);
    return add_box(scene, size, joint + part.center, part.mass);
}

Part joined(const Part& a, const Part& b) {
    Part whole{a.mass + b.mass, a.inertia + b.inertia, (a.mass * a.center + b.mass * b.center) / (a.mass + b.mass)};
    const Vec3 apart = b.center - a.center;
    const double reduced = a.mass * b.mass / whole.mass;
    for (int k = 0; k < 3; ++k) whole.inertia[k] += reduced * (apart.squaredNorm() - apart[k] * apart[k]);
    return whole;
}

// Masses, places and principal moments of ANYmal as SimBenchmark's robot.urdf gives them (products of inertia left out;
// the feet are part of the shanks). z is up.
SceneDescription quadruped_scene(int steps_per_second) {
    SceneDescription scene = empty_scene();
    scene.output.fps = steps_per_second;
    scene.simulation.steps_per_frame = 1;
    scene.simulation.sleep = false;
    scene.simulation.gravity = {0.0, 0.0, -9.81};
    add_part(scene, {21.39, {0.268388530624, 0.884235660795, 0.829158678306}, {0.022, -0.01, 0.01}}, Vec3::Zero());
    for (const double x : {1.0, -1.0})
        for (const double y : {1.0, -1.0}) {
            const auto at = [&](double along, double across, double up) { return Vec3(x * along, y * across, up); };
            const std::size_t first = scene.bodies.size();
            const Vec3 hip = at(0.2629, 0.115, 0.0), thigh = hip + at(0.0585, 0.0315, 0.0);
            const Vec3 shank = thigh + at(0.0, 0.111, -0.25);
            add_part(scene, {1.1064, {0.00123301508523, 0.000993231183395, 0.00142160349098}, at(0.0542, -0.0136, 0.0)},
                     hip);
            add_part(scene, {1.51, {0.0147571628275, 0.0144188925719, 0.00178449075964}, at(0.0008, 0.0545, -0.1975)},
                     thigh);
            const Part bone{0.318,
                            {0.0037693717909, 0.00400446467635, 0.000418471691904},
                            at(0.016355414056, -0.00562219106, -0.064350437219)};
            const Part foot{0.1922685, Vec3::Constant(8.28e-5), at(0.0, -0.016, -0.3314)};
            add_part(scene, joined(bone, foot), shank);
            add_joint(scene, JointType::hinge, 0, first, hip, Vec3::UnitX());
            add_joint(scene, JointType::hinge, first, first + 1, thigh, Vec3::UnitY());
            add_joint(scene, JointType::hinge, first + 1, first + 2, shank, Vec3::UnitY());
        }
    // No parts touch: joints that leave all free keep the others apart.
    const std::size_t hinges = scene.joints.size();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        for (std::size_t j = i + 1; j < scene.bodies.size(); ++j) {
            const bool hinged =
                std::any_of(scene.joints.begin(), scene.joints.begin() + std::ptrdiff_t(hinges),
                            [&](const JointDescription& hinge) { return hinge.first == i && hinge.second == j; });
            if (hinged) continue;
            JointDescription& apart = add_joint(scene, JointType::six_dof, i, j, scene.bodies[j].position);
            for (auto* axes : {&apart.move, &apart.turn})
                for (JointAxis& axis : *axes) axis.motion = JointAxis::Motion::free;
        }
    ForceDescription push;
    push.point = {0.1, 0.05, 0.02};
    push.force = {60.0, 90.0, 30.0};
    push.end = 1.0;
    scene.forces.push_back(push);
    return scene;
}

struct Fallen {
    double energy = 0.0;                   // J^2: mean square of the change
    double momentum = 0.0, angular = 0.0;  // kg m/s, kg m^2/s: largest change, but for that of gravity
    double gap = 0.0;                      // m
};

// A second of push, and two seconds of fall. Angular momentum about the center of mass.
Fallen fall(int steps_per_second, IntegratorKind integrator) {
    SceneDescription scene = quadruped_scene(steps_per_second);
    scene.simulation.integrator = integrator;
    World world(scene);
    double mass = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) mass += world.report(i).mass;
    for (int i = 0; i < steps_per_second; ++i) world.step();
    const auto central = [&] {
        Vec3 center = Vec3::Zero();
        const Snapshot now = world.snapshot();
        for (std::size_t i = 0; i < scene.bodies.size(); ++i)
            center += world.report(i).mass / mass * now.bodies[i].origin;
        const Measurement m = world.measure();
        return std::pair(m, Vec3(m.angular_momentum - center.cross(m.momentum)));
    };
    const auto [start, turning] = central();
    Fallen fallen;
    for (int i = 1; i <= 2 * steps_per_second; ++i) {
        world.step();
        const auto [now, angular] = central();
        const double change = now.kinetic + now.potential - start.kinetic - start.potential;
        const Vec3 fell = mass * scene.simulation.gravity * (i / double(steps_per_second));
        fallen.energy += change * change / (2.0 * steps_per_second);
        fallen.momentum = std::max(fallen.momentum, (now.momentum - start.momentum - fell).norm());
        fallen.angular = std::max(fallen.angular, (angular - turning).norm());
        fallen.gap = std::max(fallen.gap, largest_gap(world));
    }
    return fallen;
}

// SimBenchmark's figure of merit at steps of 0.01 s: 5.6e-11 J^2 for MuJoCo with RK4, 344 with Euler, 1.4 for RaiSim.
TEST(Figures, AQuadrupedFallsWithItsEnergyAndMomentum) {
    for (const IntegratorKind integrator : {IntegratorKind::exact, IntegratorKind::symplectic_euler}) {
        const Fallen fallen = fall(100, integrator);
        EXPECT_LT(fallen.energy, integrator == IntegratorKind::exact ? 1e-18 : 1e-7);
        EXPECT_LT(fallen.momentum, 1e-10);
        EXPECT_LT(fallen.angular, 2e-11);
        EXPECT_LT(fallen.gap, 1e-13);
    }
}

// Hung up at one edge, level, it swings down.
TEST(Figures, ANetOfBallsHangsTogether) {
    constexpr int side = 6;
    constexpr double apart = 0.3;
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = {0.0, -9.81, 0.0};
    scene.simulation.steps_per_frame = 4;
    scene.simulation.sleep = false;
    const auto index = [](int i, int j) { return std::size_t(i * side + j); };
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) add_sphere(scene, 0.1, {apart * i, 0.0, apart * j});
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            const Vec3 at = scene.bodies[index(i, j)].position;
            if (i + 1 < side)
                add_joint(scene, JointType::ball, index(i, j), index(i + 1, j), at + Vec3(0.5 * apart, 0.0, 0.0));
            if (j + 1 < side)
                add_joint(scene, JointType::ball, index(i, j), index(i, j + 1), at + Vec3(0.0, 0.0, 0.5 * apart));
        }
    for (int j = 0; j < side; ++j)
        add_joint(scene, JointType::ball, std::nullopt, index(0, j), scene.bodies[index(0, j)].position);
    World world(scene);
    const Measurement start = world.measure();
    double gap = 0.0, gain = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        const Measurement now = world.measure();
        gap = std::max(gap, largest_gap(world));
        gain = std::max(gain, now.kinetic + now.potential - start.kinetic - start.potential);
    }
    const double lowest = world.snapshot().bodies[index(side - 1, side / 2)].origin.y();
    EXPECT_LT(gap, 1e-5);  // level at the start, which is a singular position
    EXPECT_LT(gain, 2e-4 * world.measure().kinetic);
    EXPECT_LT(lowest, -apart);
}

/// A ring of eight boxes, of radius 1 to the middle of their sides, in the plane of its x and y axes.
Shape ring() {
    auto parts = std::make_shared<std::vector<CompoundPart>>();
    for (int i = 0; i < 8; ++i) {
        const double angle = 0.25 * std::numbers::pi * i;
        CompoundPart part;
        part.shape = BoxShape{{0.2, 0.95, 0.2}};
        part.position = {std::cos(angle), std::sin(angle), 0.0};
        part.rotation = turn(Vec3::UnitZ(), angle);
        parts->push_back(part);
    }
    return CompoundShape{parts};
}

// Each ring goes through the one above; the first is fixed.
TEST(Figures, LinkedRingsHoldEachOther) {
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = {0.0, -9.81, 0.0};
    scene.simulation.steps_per_frame = 4;
    for (int i = 0; i < 5; ++i) {
        BodyDescription& body = add_body(scene, ring(), {0.0, -1.5 * i, 0.0});
        body.mass = 1.0;
        body.restitution = 0.0;
        if (i % 2 == 1) body.rotation = turn(Vec3::UnitY(), 0.5 * std::numbers::pi);
        if (i == 0) body.type = BodyType::fixed;
        if (i > 0) body.velocity = {0.3 * i, 0.0, 0.2};
    }
    World world(scene);
    double farthest = 0.0;
    for (int frame = 0; frame < 180; ++frame) {
        world.advance_frame();
        const Snapshot now = world.snapshot();
        for (std::size_t i = 1; i < 5; ++i)
            farthest = std::max(farthest, (now.bodies[i].origin - now.bodies[i - 1].origin).norm());
    }
    EXPECT_LT(farthest, 1.9);  // two rings that hold each other: at most 2 - 2 * 0.1 m, and their corners
    EXPECT_GT(farthest, 1.6);
}

}  // namespace
}  // namespace tumble::figures_test
