// Forces and energies that the tables show: against closed forms and conservation.
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::account_test {
using namespace tumble::testing;

namespace {

/// A door in space, hinged on its vertical edge; I about the hinge.
constexpr double door_inertia = 20.0 * (0.9 * 0.9 + 0.04 * 0.04) / 12.0 + 20.0 * 0.45 * 0.45;
SceneDescription door_in_space(double spin) {
    SceneDescription scene = empty_scene();
    scene.simulation.sleep = false;
    BodyDescription& door = add_box(scene, {0.9, 2.0, 0.04}, {0.45, 0.0, 0.0}, 20.0);
    door.angular_velocity = {0.0, spin, 0.0};
    door.velocity = {0.0, 0.0, -0.45 * spin};
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY());
    return scene;
}

// Locks turn with their bodies: in steps of constant directions they do a little work, which is no impact and no heat.
constexpr double turning_error = 5e-5;  // J

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

// A box between the world and a box, on sliders: nothing but the springs' forces, so that the sum closes to rounding;
// by the default method but for its error of (h w)^2/8 of the energy, which comes and goes.
TEST(JointAccount, SpringsAndDampersKeepTheSum) {
    for (const IntegratorKind kind : {IntegratorKind::symplectic_euler, IntegratorKind::exact}) {
        SceneDescription scene = empty_scene();
        scene.simulation.integrator = kind;
        scene.simulation.sleep = false;
        for (int i = 0; i < 2; ++i) add_box(scene, {0.2, 0.2, 0.2}, {0.5 + i, 0.0, 0.0}, 1.0 + i);
        add_joint(scene, JointType::slider, std::nullopt, 0, {0.5, 0.0, 0.0}).move[0].spring =
            JointSpring{.stiffness = 100.0, .damping = 0.5, .rest = 0.3};
        add_joint(scene, JointType::slider, 0, 1, {1.5, 0.0, 0.0}).move[0].spring =
            JointSpring{.stiffness = 300.0, .damping = 0.0, .rest = -0.2};
        World world(scene);
        EXPECT_NEAR(world.measure().elastic, 0.5 * 100.0 * 0.09 + 0.5 * 300.0 * 0.04, 1e-13);
        EXPECT_LT(largest_error(world, 120), kind == IntegratorKind::exact ? 1e-11 : 2e-3);
        const EnergyLedger& ledger = world.contact_records().energy;
        EXPECT_GT(ledger.joint_heat, 1.0);
        EXPECT_EQ(ledger.friction_loss, ledger.joint_heat);
        EXPECT_EQ(ledger.work, 0.0);
        EXPECT_NEAR(ledger.impact_loss, 0.0, 1e-12);
    }
}

TEST(JointAccount, AMotorGivesItsTorqueTimesTheAngle) {
    SceneDescription scene = door_in_space(0.0);
    JointMotor motor;
    motor.speed = 5.0;
    motor.max_force = 10.0;
    scene.joints[0].turn[0].motor = motor;
    World world(scene);
    EXPECT_LT(largest_error(world, 60), turning_error);
    const double angle = world.joint_states()[0].position[3], speed = world.joint_states()[0].speed[3];
    EXPECT_NEAR(world.contact_records().energy.motor_work, 0.5 * door_inertia * speed * speed, turning_error);
    EXPECT_NEAR(world.contact_records().energy.motor_work, 10.0 * angle, 0.02 * angle);
}

TEST(JointAccount, FrictionHeatsByItsTorqueTimesTheAngle) {
    SceneDescription scene = door_in_space(2.0);
    scene.joints[0].turn[0].friction = 5.0;
    World world(scene);
    EXPECT_LT(largest_error(world, 60), turning_error);
    const double angle = world.joint_states()[0].position[3];
    EXPECT_NEAR(world.contact_records().energy.joint_heat, 5.0 * angle, 0.01 * angle);
}

TEST(JointAccount, AStopTakesTheEnergyOfADoor) {
    SceneDescription scene = door_in_space(2.0);
    scene.joints[0].turn[0].motion = JointAxis::Motion::limited;
    scene.joints[0].turn[0].upper = 1.0;
    World world(scene);
    EXPECT_LT(largest_error(world, 60), turning_error);
    EXPECT_NEAR(world.contact_records().energy.impact_loss, 0.5 * door_inertia * 4.0, turning_error);
    EXPECT_EQ(world.joint_states()[0].limit, 1);
}

TEST(JointAccount, AKinematicCarrierWorksThroughItsJoint) {
    SceneDescription scene = door_in_space(0.0);
    BodyDescription& carrier = add_box(scene, {0.1, 0.1, 0.1}, {0.0, -3.0, 0.0});
    carrier.type = BodyType::kinematic;
    carrier.interpolation = Interpolation::linear;
    carrier.keyframes = {{0.0, carrier.position, Quat::Identity()}, {2.0, carrier.position, turn(Vec3::UnitY(), 3.0)}};
    scene.joints.clear();
    JointDescription& hinge = add_joint(scene, JointType::hinge, 1, 0, Vec3::Zero(), Vec3::UnitY());
    hinge.turn[0].friction = 1.0;
    World world(scene);
    EXPECT_LT(largest_error(world, 60), turning_error);
    const EnergyLedger& ledger = world.contact_records().energy;
    EXPECT_NEAR(ledger.work, 1.0 * 1.5, 1e-9);  // torque times the carrier's angle in one second
    EXPECT_GT(ledger.joint_heat, 0.5);
}

// Over a frame, momentum changes by the joint's mean force and gravity alone; corrections have moments, but no force.
TEST(JointAccount, ForcesOfAFrameAreItsChangeOfMomentum) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    scene.bodies[0].position += Vec3(2.0, 3.0, -1.0);
    scene.joints[0].anchor_first += Vec3(2.0, 3.0, -1.0);
    World world(scene);
    world.record_contacts();
    const double frame = 1.0 / scene.output.fps;
    for (int n = 0; n < 60; ++n) {
        const Measurement before = world.measure();
        world.advance_frame();
        const Measurement after = world.measure();
        const JointState joint = world.joint_states()[0];
        const ExternalLoad& gravity = world.contact_records().loads[0];
        EXPECT_LT((after.momentum - before.momentum - frame * (joint.mean_force + gravity.force)).norm(), 1e-13);
        Vec3 moment = joint.mean_moment + gravity.moment;
        for (const ContactRecord& correction : world.contact_records().contacts) {
            EXPECT_EQ(correction.normal_force, 0.0);
            moment += correction.moment;
        }
        EXPECT_LT((after.angular_momentum - before.angular_momentum - frame * moment).norm(), 1e-12);
        EXPECT_LT((joint.point - Vec3(2.0, 3.0, -1.0)).norm(), 1e-12);
    }
}

TEST(JointAccount, ASleepingChainKeepsItsForces) {
    SceneDescription scene = pendulum_scene(0.0);
    scene.simulation.sleep = true;
    World world(scene);
    world.record_contacts();
    run(world, scene, 3.0);
    world.advance_frame();
    ASSERT_TRUE(world.snapshot().bodies[0].asleep);
    EXPECT_LT((world.joint_states()[0].mean_force - Vec3(0.0, 9.81, 0.0)).norm(), 1e-9);
}

// The force in the hinge of a rod from 90 degrees, at the bottom.
TEST(JointAccount, ThePendulumPullsAtTheBottom) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    World world(scene);
    double most = 0.0;
    for (int step = 0; step < 960; ++step) {
        world.step();
        most = std::max(most, world.joint_states()[0].force.norm());
    }
    EXPECT_NEAR(most, 24.4883042394014963, 1e-2);
}

// In flight the first body of a joint gets the work of its laws: a loss is not booked again as one of its contacts.
TEST(JointAccount, ALimitIsBookedOnceWhereTheRootHasTouched) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = 64;
    scene.simulation.sleep = false;
    add_floor(scene);
    scene.bodies.back().restitution = 0.8;
    for (int i = 0; i < 2; ++i) {
        BodyDescription& box = add_box(scene, {0.4, 0.1, 0.1}, {0.5 * i, 0.4, 0.0});
        box.restitution = 0.8;
        box.friction = 0.0;
    }
    scene.bodies[2].angular_velocity = {0.0, 0.0, -12.0};
    scene.bodies[2].velocity = {0.0, -3.0, 0.0};
    JointAxis& axis = add_joint(scene, JointType::hinge, 1, 2, {0.25, 0.4, 0.0}, Vec3::UnitZ()).turn[0];
    limit_turn(axis, -0.3, 0.3);
    axis.restitution = 0.5;
    World world(scene);
    EXPECT_LT(largest_error(world, 40), 0.05);
    EXPECT_GT(world.contact_records().energy.impact_loss, 3.0);
}

}  // namespace
}  // namespace tumble::account_test
