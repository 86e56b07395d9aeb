// Armature of joints: inertia along one coordinate alone, in all ways in which joined bodies move.
#include "joint_scenes.h"
#include "sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tumble::armature_test {
using namespace tumble::testing;

namespace {

constexpr double rod_inertia = (1.0 + 0.01) / 12.0 + 0.25;  // kg m^2, of pendulum_scene about its hinge

double balance(const World& world) {
    const Measurement m = world.measure();
    const EnergyLedger& ledger = world.contact_records().energy;
    return m.kinetic + m.potential + m.elastic + ledger.impact_loss + ledger.friction_loss - ledger.work;
}

/// The largest change of the balance in so many frames, J.
double largest_error(World& world, int frames) {
    world.record_contacts();
    const double start = balance(world);
    double worst = 0.0;
    for (int n = 0; n < frames; ++n) {
        world.advance_frame();
        worst = std::max(worst, std::abs(balance(world) - start));
    }
    return worst;
}

/// A speed out of reach: the motor gives its largest force.
JointMotor motor(double force) {
    JointMotor motor;
    motor.speed = 1e3;
    motor.max_force = force;
    return motor;
}

double agm(double a, double b) {
    for (int k = 0; k < 8; ++k) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return a;
}

// T = 2 pi / agm(1, cos(theta_0 / 2)) sqrt((I + a) / (m g l)): a frame lasts a 32nd of it.
TEST(Armature, APendulumHasThePeriodOfTheClosedForm) {
    struct Case {
        IntegratorKind integrator;
        double error;  // rad/s at the turning point
    };
    for (const double armature : {1e-6, 0.2, 30.0})
        for (const auto& [integrator, error] : {Case{IntegratorKind::exact, 1e-10},
                                                {IntegratorKind::runge_kutta_4, 1e-5},
                                                {IntegratorKind::splitting, 1e-5},
                                                {IntegratorKind::symplectic_euler, 3e-3},
                                                {IntegratorKind::explicit_euler, 0.05}}) {  // the last by rows
            constexpr double start = 1.2;
            SceneDescription scene = pendulum_scene(start);
            scene.joints[0].armature = armature;
            scene.simulation.integrator = integrator;
            const double period = 2.0 * std::numbers::pi / agm(1.0, std::cos(0.5 * start)) *
                                  std::sqrt((rod_inertia + armature) / (9.81 * 0.5));
            scene.output.fps = 32.0 / period;
            World world(scene);
            for (int frame = 0; frame < 16; ++frame) world.advance_frame();
            EXPECT_NEAR(world.joint_states()[0].speed[3], 0.0, error) << armature << ' ' << int(integrator);
            EXPECT_NEAR(world.joint_states()[0].position[3], -2.0 * start, 10.0 * error)
                << armature << ' ' << int(integrator);
        }
}

// tau / (I + a); explicit Euler moves by rows.
TEST(Armature, AMotorAcceleratesBothInertias) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::explicit_euler,
                                            IntegratorKind::runge_kutta_4, IntegratorKind::exact})
        for (const double armature : {1e-3, 0.5, 100.0}) {
            SceneDescription scene = pendulum_scene(0.0);
            scene.simulation.gravity = Vec3::Zero();
            scene.simulation.integrator = integrator;
            scene.joints[0].armature = armature;
            scene.joints[0].turn[0].motor = motor(2.0);
            World world(scene);
            world.record_contacts();
            for (int frame = 0; frame < 30; ++frame) world.advance_frame();
            const double rate = 2.0 / (rod_inertia + armature);
            const double speed = world.joint_states()[0].speed[3];
            EXPECT_NEAR(speed, 0.5 * rate, 2e-5 * rate) << int(integrator) << ' ' << armature;
            EXPECT_NEAR(world.measure().kinetic, 0.5 * (rod_inertia + armature) * speed * speed,
                        1e-9 * (rod_inertia + armature));
            EXPECT_NEAR(world.contact_records().energy.motor_work, world.measure().kinetic,
                        2e-3 * world.measure().kinetic);
        }
}

// The motor of a slider between two boxes: the relative acceleration is F g / (1 + a g) with g = 1/m1 + 1/m2.
TEST(Armature, ASliderBetweenTwoFreeBodiesKeepsTheirMomentum) {
    for (const IntegratorKind integrator : {IntegratorKind::symplectic_euler, IntegratorKind::explicit_euler}) {
        SceneDescription scene = empty_scene();
        scene.simulation.sleep = false;
        scene.simulation.gravity = Vec3::Zero();
        scene.simulation.integrator = integrator;
        for (int i = 0; i < 2; ++i) add_box(scene, {0.2, 0.2, 0.2}, {2.0 * i, 0.0, 0.0}, 1.0 + 2.0 * i);
        JointDescription& rail = add_joint(scene, JointType::slider, 0, 1, {2.0, 0.0, 0.0});
        rail.armature = 4.0;
        rail.move[0].motor = motor(3.0);
        World world(scene);
        for (int frame = 0; frame < 30; ++frame) world.advance_frame();
        constexpr double gives = 1.0 + 1.0 / 3.0;
        EXPECT_NEAR(world.joint_states()[0].speed[0], 0.5 * 3.0 * gives / (1.0 + 4.0 * gives), 1e-11);
        EXPECT_LT(world.measure().momentum.norm(), 1e-14);
    }
}

// A ball strikes the rod at its end: there the rod has the mass (I + a) / r^2.
TEST(Armature, AnImpactMeetsTheRotor) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        constexpr double armature = 0.7, speed = 2.0, mass = 1.5, arm = 0.9;
        SceneDescription scene = pendulum_scene(0.0);
        scene.simulation.gravity = Vec3::Zero();
        scene.simulation.impacts = mode;
        scene.joints[0].armature = armature;
        scene.bodies[0].restitution = 1.0;
        BodyDescription& ball = add_sphere(scene, 0.1, {0.4, -arm, 0.0}, mass);
        ball.restitution = 1.0;
        ball.velocity = {-speed, 0.0, 0.0};
        World world(scene);
        world.record_contacts();
        for (int frame = 0; frame < 12; ++frame) world.advance_frame();
        const double met = (rod_inertia + armature) / (arm * arm), common = mass * speed / (mass + met);
        EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), 2.0 * common * -1.0 + speed, 1e-9);
        EXPECT_NEAR(std::abs(world.joint_states()[0].speed[3]), 2.0 * common / arm, 1e-9);
        EXPECT_NEAR(world.measure().kinetic, 0.5 * mass * speed * speed, 1e-9);
        EXPECT_NEAR(world.contact_records().energy.impact_loss, 0.0, 1e-9);
        EXPECT_NEAR(world.contact_records().energy.friction_loss, 0.0, 1e-9);
    }
}

// A leg of two rods with rotors falls on the ground, slides and comes to rest: no energy from nothing.
TEST(Armature, BooksCloseInContactAndAtLimits) {
    for (const double armature : {0.02, 2.0}) {
        SceneDescription scene = ground_scene(0.3, 0.4);
        scene.simulation.sleep = false;
        const Quat q = turn(Vec3::UnitZ(), 0.3);
        for (int i = 0; i < 2; ++i)
            add_box(scene, {1.0, 0.1, 0.1}, q * Vec3(0.5 + i, 0.0, 0.0) + Vec3(0.0, 0.6, 0.0)).rotation = q;
        JointDescription& knee =
            add_joint(scene, JointType::hinge, 1, 2, q * Vec3::UnitX() + Vec3(0.0, 0.6, 0.0), Vec3::UnitZ());
        knee.armature = armature;
        knee.turn[0].motion = JointAxis::Motion::limited;
        knee.turn[0].lower = -0.4;
        knee.turn[0].upper = 0.3;
        knee.turn[0].spring = JointSpring{.stiffness = 2.0, .damping = 0.05};
        World world(scene);
        const double energy = world.measure().kinetic + world.measure().potential;
        EXPECT_LT(largest_error(world, 120), 2e-2 * std::abs(energy)) << armature;
        const Measurement m = world.measure();
        EXPECT_LT(m.kinetic + m.potential + m.elastic, energy);
        EXPECT_GT(world.contact_records().energy.joint_heat, -1e-6);
    }
}

// K = m w^2 of the rod without its joint, and of the armature.
TEST(Armature, ASpringByFrequencyHasIt) {
    SceneDescription scene = pendulum_scene(0.0);
    scene.simulation.gravity = Vec3::Zero();
    scene.simulation.integrator = IntegratorKind::exact;
    scene.joints[0].armature = 0.4;
    JointSpring spring;
    spring.frequency = 2.0;
    spring.rest = 0.3;
    scene.joints[0].turn[0].spring = spring;
    scene.output.fps = 32.0 * 2.0 * std::sqrt((rod_inertia - 0.25 + 0.4) / (rod_inertia + 0.4));
    World world(scene);
    for (int frame = 0; frame < 16; ++frame) world.advance_frame();
    EXPECT_NEAR(world.joint_states()[0].position[3], 0.6, 1e-9);
    for (int frame = 0; frame < 16; ++frame) world.advance_frame();
    EXPECT_NEAR(world.joint_states()[0].position[3], 0.0, 1e-9);
}

}  // namespace
}  // namespace tumble::armature_test
