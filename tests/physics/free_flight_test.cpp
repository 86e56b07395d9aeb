// Bodies that touch nothing: the discrete formulas of both Euler methods to rounding, and their convergence to the
// continuous motion.
#include "core/deterministic_math.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::free_flight_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

SceneDescription falling(IntegratorKind integrator, RotationForm form, int steps_per_frame) {
    SceneDescription scene = empty_scene(steps_per_frame);
    scene.simulation.gravity = Vec3(0.0, -g, 0.0);
    scene.simulation.integrator = integrator;
    scene.simulation.rotation = form;
    return scene;
}

// A spinning prism, I = diag(i1, i1, i3), tilted and rotating about an axis that is not a principal one.
SceneDescription top(IntegratorKind integrator, RotationForm form, int steps_per_frame) {
    SceneDescription scene = empty_scene(steps_per_frame);
    scene.simulation.integrator = integrator;
    scene.simulation.rotation = form;
    BodyDescription& body = add_box(scene, {1.0, 1.0, 0.3}, Vec3::Zero());
    body.rotation = turn({1.0, 0.3, 0.0}, 0.4);
    body.angular_velocity = Vec3(0.5, 1.0, 4.0);
    return scene;
}

}  // namespace

// Explicit Euler: x_n = x0 + n h v0 + g h^2 n(n-1)/2; symplectic Euler: ... n(n+1)/2; v_n = v0 + n h g in both.
TEST(FreeFall, BothEulersFollowTheirDiscreteFormulas) {
    for (const auto integrator : {IntegratorKind::explicit_euler, IntegratorKind::symplectic_euler}) {
        SceneDescription scene = falling(integrator, RotationForm::quaternion, 4);
        BodyDescription& body = add_sphere(scene, 0.5, {1.0, 20.0, -3.0});
        body.velocity = Vec3(2.0, 3.0, -1.0);
        World world(scene);
        const double h = scene.step();
        for (int frame = 1; frame <= 60; ++frame) {
            world.advance_frame();
            const double n = 4.0 * frame;
            const double half = integrator == IntegratorKind::explicit_euler ? n * (n - 1) / 2 : n * (n + 1) / 2;
            const BodyState b = world.snapshot().bodies[0];
            const Vec3 expected = body.position + n * h * body.velocity + Vec3(0.0, -g * h * h * half, 0.0);
            EXPECT_LT((b.center_of_mass - expected).norm(), 1e-12);
            EXPECT_LT((b.velocity - (body.velocity + Vec3(0.0, -g * n * h, 0.0))).norm(), 1e-12);
        }
    }
}

TEST(FreeFall, ProjectileConvergesToTheParabolaAtFirstOrder) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
        SceneDescription scene = falling(IntegratorKind::symplectic_euler, RotationForm::quaternion, 8 << k);
        BodyDescription& body = add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.0, 0.0});
        body.velocity = Vec3(5.0, 9.81, 0.0);
        World world(scene);
        run(world, scene, 1.0);
        const Vec3 exact(5.0, 9.81 - 0.5 * g, 0.0);
        error[k] = (world.snapshot().bodies[0].center_of_mass - exact).norm();
    }
    EXPECT_NEAR(error[0], 0.5 * g / 480.0, 1e-12);  // h g t / 2
    EXPECT_NEAR(error[0] / error[1], 2.0, 1e-9);
}

TEST(FreeRotation, AngularMomentumStaysToTheLastBitAndRotationsStayRotations) {
    for (const auto form : {RotationForm::quaternion, RotationForm::matrix}) {
        const SceneDescription scene = top(IntegratorKind::symplectic_euler, form, 16);
        World world(scene);
        const Vec3 before = world.measure().angular_momentum;
        run(world, scene, 5.0);
        EXPECT_EQ(world.measure().angular_momentum, before);
        EXPECT_NEAR(world.snapshot().bodies[0].orientation.norm(), 1.0, 1e-15);
    }
}

// A symmetric top precesses about L at |L| / I1 (Landau and Lifshitz, "Mechanics", section 33). Explicit Euler rotates
// by the tangent, to first order; symplectic Euler by the mean angular velocity, to third.
TEST(FreeRotation, SymmetricTopPrecessesAtTheClosedFormRate) {
    for (const auto integrator : {IntegratorKind::explicit_euler, IntegratorKind::symplectic_euler}) {
        for (const auto form : {RotationForm::quaternion, RotationForm::matrix}) {
            double error[2];
            for (int k = 0; k < 2; ++k) {
                const SceneDescription scene = top(integrator, form, 32 << k);
                World world(scene);
                const Vec3 momentum = world.measure().angular_momentum;
                const double i1 = (1.0 + 0.3 * 0.3) / 12.0;
                const Vec3 axis = scene.bodies[0].rotation * Vec3::UnitZ();
                run(world, scene, 1.0);
                const Vec3 exact = Eigen::AngleAxisd(momentum.norm() / i1, momentum.normalized()) * axis;
                error[k] = (world.snapshot().bodies[0].orientation * Vec3::UnitZ() - exact).norm();
            }
            const bool tangent = integrator == IntegratorKind::explicit_euler;
            EXPECT_LT(error[1], tangent ? 0.02 : 2e-7);
            EXPECT_NEAR(error[0] / error[1], tangent ? 2.0 : 8.0, 0.1);
        }
    }
}

// About a principal axis only the angle changes. A step of explicit Euler advances it by 2 atan(h w / 2), or atan(h w);
// symplectic Euler by h w.
TEST(FreeRotation, OneStepRotatesByTheAngleOfItsForm) {
    for (const auto integrator : {IntegratorKind::explicit_euler, IntegratorKind::symplectic_euler})
        for (const auto form : {RotationForm::quaternion, RotationForm::matrix}) {
            SceneDescription scene = empty_scene(1);
            scene.simulation.integrator = integrator;
            scene.simulation.rotation = form;
            add_box(scene, {1.0, 2.0, 3.0}, Vec3::Zero()).angular_velocity = Vec3(0.0, 12.0, 0.0);
            add_sphere(scene, 0.5, {5.0, 0.0, 0.0}).angular_velocity = Vec3(0.0, 12.0, 0.0);
            World world(scene);
            world.step();
            const double hw = 12.0 / 60.0,
                         tangent = form == RotationForm::quaternion ? 2.0 * std::atan(0.5 * hw) : std::atan(hw);
            const double angle = integrator == IntegratorKind::explicit_euler ? tangent : hw;
            for (const BodyState& body : world.snapshot().bodies)
                EXPECT_LT((body.orientation.coeffs() - turn(Vec3::UnitY(), angle).coeffs()).norm(), 1e-14);
        }
}

// The notes' reason for symplectic Euler: for free rotation (here a spinning asymmetric body without wind) explicit
// Euler gains kinetic energy steadily.
TEST(FreeRotation, ExplicitEulerDriftsMoreThanSymplecticEuler) {
    double gain[2];
    for (int k = 0; k < 2; ++k) {
        SceneDescription scene = empty_scene(16);
        scene.simulation.integrator = k == 0 ? IntegratorKind::explicit_euler : IntegratorKind::symplectic_euler;
        BodyDescription& body = add_box(scene, {1.0, 0.6, 0.2}, Vec3::Zero());
        body.angular_velocity = Vec3(0.01, 5.0, 0.01);
        World world(scene);
        const double before = world.measure().kinetic;
        run(world, scene, 10.0);
        gain[k] = std::abs(world.measure().kinetic / before - 1.0);
    }
    EXPECT_LE(gain[1], gain[0] + 1e-12);
}

// tau = r x F (notes eq. 6) over a time span: L = tau t, P = F t, exactly the steps that begin inside the span.
TEST(PointForce, GivesTorqueDuringItsSpan) {
    SceneDescription scene = empty_scene(10);
    add_box(scene, {1.0, 1.0, 1.0}, {2.0, 0.0, 0.0}, 3.0);
    scene.forces.push_back({0, Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.0, 2e-3), false, 0.25, 0.75});
    World world(scene);
    run(world, scene, 0.25);
    EXPECT_EQ(world.measure().momentum, Vec3::Zero());
    run(world, scene, 1.0);
    const Measurement m = world.measure();
    EXPECT_NEAR(m.momentum.z(), 1e-3, 1e-12);
    const Vec3 spin = m.angular_momentum - world.snapshot().bodies[0].center_of_mass.cross(m.momentum);
    EXPECT_NEAR(spin.y(), -0.5e-3, 1e-6);  // the arm rotates a little while the force stays
}

TEST(PointForce, BodyFrameForceRotatesWithTheBody) {
    SceneDescription scene = empty_scene(16);
    BodyDescription& body = add_sphere(scene, 0.5, Vec3::Zero(), 2.0);
    body.angular_velocity = Vec3(0.0, 2.0 * pi, 0.0);  // one revolution per second
    scene.forces.push_back({0, Vec3::Zero(), Vec3(4.0, 0.0, 0.0), true, 0.0, 1.0});
    World world(scene);
    run(world, scene, 1.0);
    EXPECT_LT(world.measure().momentum.norm(), 0.02);  // a whole revolution cancels; remainder of order h
}

// Quadratic drag: v(t) = v_t tanh(g t / v_t), v_t = sqrt(2 m g / (rho C_d A)).
TEST(Wind, FallReachesTerminalVelocity) {
    SceneDescription scene = falling(IntegratorKind::symplectic_euler, RotationForm::quaternion, 64);
    scene.wind = WindDescription{Vec3::Zero(), 1.2, 0.47};
    add_sphere(scene, 0.5, {0.0, 1000.0, 0.0}, 2.0);
    World world(scene);
    const double terminal = std::sqrt(2.0 * 2.0 * g / (1.2 * 0.47 * pi * 0.25));
    run(world, scene, 1.0);
    EXPECT_NEAR(-world.snapshot().bodies[0].velocity.y(), terminal * std::tanh(g / terminal), 2e-3);
    run(world, scene, 9.0);
    EXPECT_NEAR(-world.snapshot().bodies[0].velocity.y(), terminal, 1e-7);  // tanh(g t / v_t) is 2e-9 short of 1
}

TEST(Wind, CarriesAFloatingBodyUpToItsOwnSpeed) {
    SceneDescription scene = empty_scene(16);
    scene.wind = WindDescription{Vec3(3.0, 0.0, 0.0), 1.2, 1.0};
    add_box(scene, {1.0, 1.0, 1.0}, Vec3::Zero(), 0.5);
    World world(scene);
    run(world, scene, 2.0);
    // du/dt = -k u^2 with k = rho C_d A / 2m and A = 6/4: u = u0 / (1 + k u0 t).
    const double k = 1.2 * 1.5 / (2.0 * 0.5);
    EXPECT_NEAR(world.snapshot().bodies[0].velocity.x(), 3.0 - 3.0 / (1.0 + k * 3.0 * 2.0), 5e-3);
}

}  // namespace tumble::free_flight_test
