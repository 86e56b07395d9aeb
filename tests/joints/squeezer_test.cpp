// Andrews' squeezer, IFToMM's A03: seven bodies, four loops, a crank that turns 15.9 rad in 0.03 s. Parameters: test set
// for initial value problems; Hairer and Wanner, Solving Ordinary Differential Equations II. References: 113-bit
// arithmetic; the published values agree with them to 1.4e-9.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::squeezer_test {
using namespace tumble::testing;

namespace {

constexpr double beta = -0.06171389001427644964, gamma = 0.45527981916307038026, phi = 0.22266839016588588467,
                 delta = 0.48736497954384255023, omega = -phi, epsilon = 1.2305474445498211925;
constexpr double duration = 0.03;  // s

Vec3 at(double x, double y) { return {x, y, 0.0}; }
/// (cos a, sin a), and (sin a, -cos a).
Vec3 along(double angle) { return at(std::cos(angle), std::sin(angle)); }
Vec3 aside(double angle) { return at(std::sin(angle), -std::cos(angle)); }

/// A square plate with that moment of inertia about z.
void add_plate(SceneDescription& scene, double mass, double inertia, double angle, const Vec3& center) {
    const double side = std::sqrt(6.0 * inertia / mass);
    const Vec3 layer(0.0, 0.0, 0.02 * double(scene.bodies.size()));  // the plates pass each other
    add_box(scene, {side, side, 0.01}, center + layer, mass).rotation = turn(Vec3::UnitZ(), angle);
}

SceneDescription squeezer_scene(int steps) {
    constexpr double d = 0.028, da = 0.0115, e = 0.02, ea = 0.01421, rr = 0.007, ra = 0.00092, sa = 0.01874,
                     sb = 0.01043, sc = 0.018, sd = 0.02, ta = 0.02308, tb = 0.00916, u = 0.04, ua = 0.01228,
                     ub = 0.00449, zf = 0.02, zt = 0.04, fa = 0.01421;
    const Vec3 a = at(-0.06934, -0.00227), b = at(-0.03635, 0.03273), c = at(0.014, 0.072);
    SceneDescription scene = empty_scene();
    scene.output.fps = 1.0 / duration;
    scene.simulation.steps_per_frame = steps;
    scene.simulation.sleep = false;
    add_plate(scene, 0.04325, 2.194e-6, beta, ra * along(beta));
    add_plate(scene, 0.00365, 4.410e-7, beta, rr * along(beta) - da * along(beta));
    add_plate(scene, 0.02373, 5.255e-6, gamma, b + sa * aside(gamma) + sb * along(gamma));
    add_plate(scene, 0.00706, 5.667e-7, phi + delta, a + zt * along(delta) + (e - ea) * aside(phi + delta));
    add_plate(scene, 0.07050, 1.169e-5, delta, a + ta * along(delta) - tb * aside(delta));
    add_plate(scene, 0.00706, 5.667e-7, omega + epsilon, a + u * aside(epsilon) + (zf - fa) * along(omega + epsilon));
    add_plate(scene, 0.05498, 1.912e-5, epsilon, a + ua * aside(epsilon) - ub * along(epsilon));
    const Vec3 meeting = rr * along(beta) - d * along(beta);
    const auto hinge = [&](std::optional<std::size_t> first, std::size_t second, const Vec3& anchor) {
        add_joint(scene, JointType::hinge, first, second, anchor, Vec3::UnitZ());
    };
    hinge(std::nullopt, 0, Vec3::Zero());
    hinge(0, 1, rr * along(beta));
    hinge(std::nullopt, 2, b);
    hinge(std::nullopt, 4, a);
    hinge(std::nullopt, 6, a);
    hinge(4, 3, a + zt * along(delta));
    hinge(6, 5, a + u * aside(epsilon));
    hinge(1, 2, meeting);
    hinge(1, 3, meeting);
    hinge(1, 5, meeting);
    // A couple of two forces, fixed in the crank.
    for (const double side : {-1.0, 1.0}) {
        ForceDescription force;
        force.body = 0;
        force.point = at(0.0, -0.5 * side);
        force.force = at(0.033 * side, 0.0);
        force.body_frame = true;
        force.end = infinity;
        scene.forces.push_back(force);
    }
    JointDescription& spring = add_joint(scene, JointType::distance, std::nullopt, 2, c);
    spring.anchor_second =
        scene.bodies[2].rotation.conjugate() * (b + sc * aside(gamma) + sd * along(gamma) - scene.bodies[2].position);
    for (JointAxis& axis : spring.turn) axis.motion = JointAxis::Motion::free;
    for (JointAxis& axis : spring.move) axis.motion = JointAxis::Motion::free;
    spring.move[0].spring = JointSpring{.stiffness = 4530.0, .damping = 0.0, .rest = 0.07785};
    return scene;
}

struct Squeezed {
    double error = 0.0, gap = 0.0;  // rad: largest of the seven angles at the end; m
};

Squeezed squeeze(int steps, IntegratorKind integrator) {
    SceneDescription scene = squeezer_scene(steps);
    scene.simulation.integrator = integrator;
    World world(scene);
    Squeezed result;
    for (int i = 0; i < steps; ++i) {
        world.step();
        result.gap = std::max(result.gap, largest_gap(world));
    }
    const auto joints = world.joint_states();
    const double expected[] = {15.81077119515371,   -15.75637105841184,   0.04082224011964581, 0.52440996587995407,
                               1.04808074104193787, -0.53473011634207958, 0.53473011634207958};
    const double start[] = {beta, 0.0, gamma, delta, epsilon, phi, omega};
    for (std::size_t k = 0; k < 7; ++k) {
        const double angle = start[k] + joints[k].position[3];
        result.error = std::max(result.error, std::abs(angle - expected[k]));
    }
    return result;
}

TEST(JointReference, AndrewsSqueezer) {
    const Squeezed squeezed = squeeze(360, IntegratorKind::exact);
    EXPECT_LT(squeezed.error, 1e-11);
    EXPECT_LT(squeezed.gap, 1e-14);
}

TEST(JointReference, AndrewsSqueezerWithDefaultFlight) {
    const Squeezed coarse = squeeze(720, IntegratorKind::symplectic_euler);
    const Squeezed fine = squeeze(1440, IntegratorKind::symplectic_euler);  // 1/48,000 s
    EXPECT_LT(fine.error, 3e-4);
    EXPECT_NEAR(coarse.error / fine.error, 4.0, 0.1);
    EXPECT_LT(fine.gap, 1e-14);
}

}  // namespace
}  // namespace tumble::squeezer_test
