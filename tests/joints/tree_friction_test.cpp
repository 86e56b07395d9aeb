// Dry friction of trees in flight against closed forms: swings of a pendulum, a spring, stops; in worlds of both modes.
#include "tree_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::tree_friction_test {
namespace {

using namespace testing;
using std::numbers::pi;
using Outcome = TreeFlight::Outcome;

constexpr double weight = 9.81, half = 0.5;  // N, m: of the rod

double hanging_angle(const Body& body) {
    const Vec3 d = body.orientation * Vec3::UnitX();
    return std::atan2(d.x(), -d.y());
}

SceneDescription braked_pendulum(double torque, int steps_per_frame = 1) {
    SceneDescription scene = pendulum_scene(0.5 * pi, steps_per_frame);
    scene.simulation.integrator = IntegratorKind::exact;
    scene.joints[0].turn[0].friction = torque;
    return scene;
}

// Where a swing ends that begins at rest at `start` (rad from hanging, above 0): the energy lost is the torque times
// the angle that it covers.
double end_of_swing(double start, double torque) {
    double low = -pi, high = start;  // of the other turning point
    const auto left = [&](double end) {
        return weight * half * (std::cos(end) - std::cos(start)) - torque * (start - end);
    };
    // Past the lowest point the energy that is left falls with the angle.
    high = std::asin(torque / (weight * half));
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (left(middle) < 0.0 ? low : high) = middle;
    }
    return low;
}

// J19 of the design note: 0.5 N m from 90 degrees.
TEST(TreeFriction, APendulumLosesTheTorqueTimesTheAngle) {
    for (const double rate : {60.0, 240.0}) {
        const double torque = 0.5;
        TreeScene t(braked_pendulum(torque));
        const double energy = t.energy();
        double covered = 0.0, last = 0.5 * pi, from = 0.5 * pi, before = 0.0, most_at_turn = 0.0;
        int turns = 0;
        for (int k = 0; k < int(20.0 * rate); ++k) {
            ASSERT_EQ(t.step(1.0 / rate), Outcome::flown);
            const Body& body = t.set.bodies[0];
            const double now = hanging_angle(body), speed = body.angular_velocity.z();
            if (speed * before < 0.0 || (speed == 0.0 && before != 0.0)) {  // a turn within the step
                const double sign = from > 0.0 ? 1.0 : -1.0, turn = sign * end_of_swing(sign * from, torque);
                covered += std::abs(turn - last) + std::abs(now - turn);
                from = turn;
                ++turns;
                if (speed == 0.0) most_at_turn = std::abs(now - turn);
            } else {
                covered += std::abs(now - last);
                if (speed != 0.0) {
                    EXPECT_NEAR(t.list[0]->torque.z(), -std::copysign(torque, speed), 1e-5);  // Simpson's rule
                }
            }
            EXPECT_NEAR(t.energy(), energy - torque * covered, 1e-12);
            last = now;
            before = speed;
        }
        EXPECT_GT(turns, 5);
        EXPECT_LT(most_at_turn, 1e-12);
        EXPECT_EQ(before, 0.0);
        EXPECT_LT(weight * half * std::abs(std::sin(last)), torque);
    }
}

// A mass on a spring with friction: each half swing takes pi / w and loses twice the bound over the stiffness.
TEST(TreeFriction, ASpringComesToRestWhereFrictionHoldsIt) {
    for (const bool swapped : {false, true})
        for (const IntegratorKind method : {IntegratorKind::exact, IntegratorKind::runge_kutta_4}) {
            const double stiffness = 50.0, mass = 2.0, bound = 3.0, start = 0.5;
            SceneDescription scene = empty_scene(1);
            add_box(scene, {0.3, 0.3, 0.3}, Vec3::Zero(), mass);
            const std::optional<std::size_t> world, body = 0;
            JointDescription& joint = add_joint(scene, JointType::slider, swapped ? body : world,
                                                swapped ? world : body, Vec3::Zero(), Vec3::UnitZ());
            JointSpring law;
            law.stiffness = stiffness;
            law.rest = swapped ? start : -start;
            joint.move[0].spring = law;
            joint.move[0].friction = bound;
            TreeScene t(scene);
            const double rate = 240.0, w = std::sqrt(stiffness / mass),
                         tolerance = method == IntegratorKind::exact ? 1e-12 : 1e-7;
            for (int k = 1; k <= 1000; ++k) {
                ASSERT_EQ(t.step(1.0 / rate, method), Outcome::flown);
                // From the place x0 of a half swing about the place bound / stiffness on the same side.
                const double time = k / rate;
                const int swing = int(time * w / pi);
                double from = start;
                for (int s = 0; s < swing && std::abs(from) * stiffness > bound; ++s)
                    from = -(from - std::copysign(2.0 * bound / stiffness, from));
                double x = from, speed = 0.0;
                if (std::abs(from) * stiffness > bound) {
                    const double middle = std::copysign(bound / stiffness, from), phase = time * w - swing * pi;
                    x = middle + (from - middle) * std::cos(phase);
                    speed = -w * (from - middle) * std::sin(phase);
                }
                EXPECT_NEAR(t.set.bodies[0].position.z(), x - start, tolerance) << k;
                EXPECT_NEAR(t.set.bodies[0].velocity.z(), speed, 10.0 * tolerance) << k;
            }
            EXPECT_EQ(t.set.bodies[0].velocity.z(), 0.0);
        }
}

// Three rods, some of whose hinges are held and let go again: the energy that leaves is the heat of friction, and the
// motion does not depend on the step.
TEST(TreeFriction, HeldHingesAreLetGoAtTheirBound) {
    const auto run_at = [](int rate) {
        SceneDescription scene = double_pendulum_scene(1);
        add_box(scene, {1.0, 0.1, 0.1}, {2.5, 0.0, 0.0});
        add_joint(scene, JointType::hinge, 1, 2, 2.0 * Vec3::UnitX(), Vec3::UnitZ());
        scene.joints[1].turn[0].friction = 4.0;
        scene.joints[2].turn[0].friction = 1.5;
        TreeScene t(scene);
        const double energy = t.energy();
        int held = 0;
        for (int k = 0; k < 3 * rate; ++k) {
            EXPECT_EQ(t.step(1.0 / rate), Outcome::flown);
            const double relative = t.set.bodies[2].angular_velocity.z() - t.set.bodies[1].angular_velocity.z();
            held += std::abs(relative) < 1e-11;
            t.joints.end_step();
            double heat = 0.0;
            for (const Joint* joint : t.list) heat += joint->account.work.heat;
            EXPECT_NEAR(t.energy() + heat, energy, 1e-11);
        }
        EXPECT_GT(held, rate / 20);
        EXPECT_LT(held, 3 * rate - rate / 20);
        return t.set.bodies[2].position;
    };
    EXPECT_LT((run_at(60) - run_at(240)).norm(), 1e-8);
}

// In worlds of both modes: the account balances, and the pendulum falls asleep.
TEST(TreeFriction, APendulumFallsAsleep) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = braked_pendulum(0.5, 2);
        scene.simulation.impacts = mode;
        scene.simulation.sleep = true;
        World world(scene);
        world.record_contacts();
        const auto total = [&] {
            const Measurement m = world.measure();
            return m.kinetic + m.potential + world.contact_records().energy.joint_heat;
        };
        const double start = total();
        for (int frame = 0; frame < 1200; ++frame) {
            world.advance_frame();
            EXPECT_NEAR(total(), start, 1e-11);
        }
        EXPECT_TRUE(world.snapshot().bodies[0].asleep);
        EXPECT_GT(world.contact_records().energy.joint_heat, 4.0);
    }
}

// Friction of balls is along no coordinate: rows move them.
TEST(TreeFriction, FrictionOfBallsIsDeclined) {
    SceneDescription scene = pendulum_scene(0.5 * pi);
    scene.joints[0].type = JointType::ball;
    for (JointAxis& axis : scene.joints[0].turn) axis.motion = JointAxis::Motion::free;
    EXPECT_EQ(TreeScene(scene).step(1.0 / 60.0), Outcome::flown);
    for (JointAxis& axis : scene.joints[0].turn) axis.friction = 0.1;
    EXPECT_EQ(TreeScene(scene).step(1.0 / 60.0), Outcome::declined);
}

}  // namespace
}  // namespace tumble::tree_friction_test
