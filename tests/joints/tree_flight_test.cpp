// Trees in flight in joint coordinates against closed forms, references of 20 digits, and conservation laws.
#include "harness/breaking_pendulum.h"
#include "tree_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::tree_flight_test {
using namespace tumble::testing;

namespace {

using std::numbers::pi;
using Outcome = TreeFlight::Outcome;

double angle_of(const Body& body) {
    const Vec3 d = body.orientation * Vec3::UnitX();
    return std::atan2(d.x(), -d.y());
}

// A hinged rod released at 10, 90 and 170 degrees: after a period K(sin^2(angle / 2)) 4 / w it is back and at rest.
TEST(TreeFlight, PeriodsOfAPhysicalPendulum) {
    const double periods[3][2] = {
        {10.0, 1.64312051580774093}, {90.0, 1.9357500144084348}, {170.0, 4.00053715316770717}};
    for (const auto& [degrees, period] : periods) {
        TreeScene t(pendulum_scene(degrees * pi / 180.0));
        const int steps = int(std::ceil(240.0 * period));
        for (int k = 0; k < steps; ++k) ASSERT_EQ(t.step(period / steps), Outcome::flown);
        const double start = degrees * pi / 180.0;
        const double pull = 9.81 * 0.5 * std::sin(start) / (1.01 / 12.0 + 0.25);
        EXPECT_NEAR(angle_of(t.set.bodies[0]), start, 1e-12);
        EXPECT_LT(std::abs(t.set.bodies[0].angular_velocity.z() / pull), 2e-12);  // s: the error of the period
    }
}

// The force in its hinge at the bottom, from 90 degrees.
TEST(TreeFlight, ThePullOfAPendulumAtTheBottom) {
    TreeScene t(pendulum_scene(0.5 * pi));
    const double h = 0.25 * 1.9357500144084348 / 120;
    for (int k = 0; k < 120; ++k) ASSERT_EQ(t.step(h), Outcome::flown);
    const auto force = [&](std::size_t k) { return t.list[0]->impulse[k][Joint::lock] / h; };
    EXPECT_NEAR(std::hypot(force(0), force(1), force(2)), 24.4883042394014963, 1e-10);
}

TEST(TreeFlight, ADoublePendulumToTheLastDigits) {
    TreeScene t(double_pendulum_scene(1));
    for (int k = 1; k <= 600; ++k) {
        ASSERT_EQ(t.step(1.0 / 120.0), Outcome::flown);
        if (k == 240) {
            EXPECT_NEAR(angle_of(t.set.bodies[0]), -0.0845270358378211, 1e-12);
            EXPECT_NEAR(angle_of(t.set.bodies[1]), 0.3920419302606883, 1e-12);
        }
    }
    EXPECT_NEAR(angle_of(t.set.bodies[0]), 0.8485748006037753, 1e-11);
    EXPECT_NEAR(angle_of(t.set.bodies[1]), 2.3633801429516465, 1e-11);
}

TEST(TreeFlight, RungeKuttaHasOrderFour) {
    const auto error = [](int rate) {
        TreeScene t(double_pendulum_scene(1));
        for (int k = 0; k < rate; ++k) EXPECT_EQ(t.step(1.0 / rate, IntegratorKind::runge_kutta_4), Outcome::flown);
        return std::hypot(angle_of(t.set.bodies[0]) - -1.2043240792353393,
                          angle_of(t.set.bodies[1]) - -0.8199807116655024);
    };
    const double coarse = error(120), fine = error(240);
    EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.4);
    EXPECT_LT(fine, 1e-7);
}

/// A body of 18 degrees of freedom: four legs of three hinges, as a walking robot of 30 kg.
SceneDescription quadruped() {
    SceneDescription scene;
    add_box(scene, {0.6, 0.25, 0.25}, Vec3::Zero(), 16.8);
    for (int leg = 0; leg < 4; ++leg) {
        const double front = leg < 2 ? 1.0 : -1.0, side = leg % 2 ? 1.0 : -1.0;
        const Vec3 hip(0.277 * front, 0.0, 0.116 * side), thigh = hip + Vec3(0.0635 * front, 0.0, 0.041 * side),
                                                          knee = thigh + Vec3(0.0, -0.25, 0.109 * side);
        const std::size_t first = scene.bodies.size();
        add_box(scene, {0.1, 0.1, 0.12}, hip + Vec3(0.06 * front, 0.0, 0.0), 1.42);
        add_box(scene, {0.06, 0.3, 0.06}, thigh + Vec3(0.0, -0.14, 0.05 * side), 1.63);
        add_box(scene, {0.05, 0.33, 0.05}, knee + Vec3(0.02, -0.15, 0.0), 0.21);
        add_joint(scene, JointType::hinge, 0, first, hip, Vec3::UnitX());
        add_joint(scene, JointType::hinge, first, first + 1, thigh, Vec3::UnitZ());
        add_joint(scene, JointType::hinge, first + 1, first + 2, knee, Vec3::UnitZ());
    }
    ForceDescription push;
    push.body = 0;
    push.point = {0.1, 0.05, 0.05};
    push.force = {100.0, 50.0, 30.0};
    push.end = 1.0;
    scene.forces.push_back(push);
    return scene;
}

// Pushed for a second, then in free fall for two, in steps of 0.01 s.
TEST(TreeFlight, AQuadrupedInFreeFall) {
    for (const IntegratorKind method : {IntegratorKind::exact, IntegratorKind::runge_kutta_4}) {
        TreeScene t(quadruped());
        const double mass = 16.8 + 4.0 * (1.42 + 1.63 + 0.21);
        for (int k = 0; k < 100; ++k) ASSERT_EQ(t.step(0.01, method), Outcome::flown);
        const Vec3 momentum = Vec3(100.0, 50.0, 30.0) + mass * t.forces.gravity();
        EXPECT_LT((t.momentum() - momentum).norm(), 1e-12 * momentum.norm());
        const Vec3 turn = t.angular_momentum();
        const double energy = t.energy();
        double square = 0.0;
        for (int k = 0; k < 200; ++k) {
            ASSERT_EQ(t.step(0.01, method), Outcome::flown);
            square += std::pow(t.energy() - energy, 2) / 200.0;
        }
        EXPECT_LT(square, method == IntegratorKind::exact ? 1e-20 : 1e-14);  // J^2
        EXPECT_LT((t.angular_momentum() - turn).norm(), 1e-12);
        EXPECT_LT((t.momentum() - momentum - 2.0 * mass * t.forces.gravity()).norm(), 1e-12 * momentum.norm());
    }
}

// Without forces, also by the method of order 4: P and L about a fixed point, and the path of the center of mass.
TEST(TreeFlight, AFreeChainKeepsItsMomentaToTheLastDigits) {
    for (const IntegratorKind method : {IntegratorKind::exact, IntegratorKind::runge_kutta_4}) {
        SceneDescription scene = free_chain_scene();
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) {  // a rigid motion
            scene.bodies[i].angular_velocity = {0.3, 0.5, 0.7};
            scene.bodies[i].velocity = Vec3(0.1, -0.2, 0.3) + Vec3(0.3, 0.5, 0.7).cross(scene.bodies[i].position);
        }
        TreeScene t(scene);
        const Vec3 momentum = t.momentum(), center = t.center();
        const auto about_origin = [&] { return Vec3(t.angular_momentum() + t.center().cross(t.momentum())); };
        const Vec3 turn = about_origin();
        double gap = 0.0;
        for (int k = 0; k < 600; ++k) {
            ASSERT_EQ(t.step(1.0 / 60.0, method), Outcome::flown);
            for (const Joint* joint : t.list) {
                const JointGeometry g =
                    measure(*joint, side_of(t.set.bodies, joint->a), side_of(t.set.bodies, joint->b));
                for (std::size_t c = 0; c < 3; ++c) gap = std::max(gap, std::abs(g.coordinates[c].value));
            }
        }
        EXPECT_LT((t.momentum() - momentum).norm(), 1e-14 * momentum.norm());
        EXPECT_LT((about_origin() - turn).norm(), 2e-14 * turn.norm());
        EXPECT_LT((t.center() - center - 10.0 / 8.0 * momentum).norm(), 1e-12);
        EXPECT_LT(gap, 1e-14);
    }
}

// A thrust across the end of a rod, fixed in the rod, for a time between steps: constant torque.
TEST(TreeFlight, AThrustBetweenSteps) {
    SceneDescription scene = empty_scene();
    add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0});
    add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
    ForceDescription thrust;
    thrust.body = 0;
    thrust.point = {0.5, 0.0, 0.0};
    thrust.force = {0.0, 2.0, 0.0};
    thrust.body_frame = true;
    thrust.start = 0.1234;
    thrust.end = 0.5678;
    scene.forces.push_back(thrust);
    TreeScene t(scene);
    const double rate = 2.0 / (1.01 / 12.0 + 0.25), span = thrust.end - thrust.start;
    for (int k = 0; k < 60; ++k) ASSERT_EQ(t.step(1.0 / 60.0), Outcome::flown);
    EXPECT_NEAR(t.set.bodies[0].angular_velocity.z(), rate * span, 1e-12);
    EXPECT_NEAR(t.list[0]->value[3], 0.5 * rate * span * span + rate * span * (1.0 - thrust.end), 1e-12);
}

// Air: the error is rounding at any step; the impulses of the joints are what the bodies' forces leave.
TEST(TreeFlight, AChainInTheWind) {
    const auto run_with = [](int rate) {
        SceneDescription scene = double_pendulum_scene(1);
        scene.wind = WindDescription{};
        scene.wind->velocity = {5.0, 1.0, 3.0};
        scene.wind->density = 1.2;
        scene.wind->drag = 1.0;
        scene.joints[0].type = scene.joints[1].type = JointType::ball;
        for (JointDescription& joint : scene.joints)
            for (JointAxis& axis : joint.turn) axis.motion = JointAxis::Motion::free;
        TreeScene t(scene);
        for (int k = 0; k < rate; ++k) EXPECT_EQ(t.step(1.0 / rate), Outcome::flown);
        return t.set.bodies[1].position;
    };
    EXPECT_LT((run_with(60) - run_with(480)).norm(), 1e-11);
}

TEST(TreeFlight, StopsAtALimitAndAtAStrength) {
    SceneDescription scene = pendulum_scene(0.5 * pi);
    scene.joints[0].turn[0].motion = JointAxis::Motion::limited;
    scene.joints[0].turn[0].lower = -0.5;
    TreeScene limited(scene);
    while (limited.time < 1.0) ASSERT_EQ(limited.step(1.0 / 960.0), Outcome::flown);
    EXPECT_NEAR(limited.list[0]->value[3], -0.5, 1e-15);
    EXPECT_EQ(limited.set.bodies[0].angular_velocity.z(), 0.0);
    scene = pendulum_scene(0.5 * pi);
    scene.joints[0].break_force = bench::breaking_pendulum::strength;
    TreeScene weak(scene);
    while (!weak.list[0]->broken) ASSERT_EQ(weak.step(1.0 / 960.0), Outcome::flown);
    EXPECT_NEAR(weak.list[0]->broken_at, bench::breaking_pendulum::time, 1.0 / 960.0);
}

// At its time within a step, from where the rod flies freely: constant angular velocity, and the parabola of its
// center.
TEST(TreeFlight, AJointBreaksAtItsTime) {
    using namespace bench::breaking_pendulum;
    for (const double rate : {60.0, 77.0, 960.0}) {
        SceneDescription scene = pendulum_scene(0.5 * pi);
        scene.joints[0].break_force = strength;
        TreeScene t(scene);
        const double energy = t.energy();
        while (!t.list[0]->broken) {
            const Vec3 before = t.momentum();
            ASSERT_EQ(t.step(1.0 / rate), Outcome::flown);
            const Vec3 given = t.list[0]->account.step.reaction.force + 1.0 / rate * t.forces.gravity();
            EXPECT_LT((t.momentum() - before - given).norm(), 1e-14);
        }
        EXPECT_NEAR(t.list[0]->broken_at, time, 1e-14);
        const Body& rod = t.set.bodies[0];
        const double since = t.time - time, speed = -angular_speed;
        EXPECT_NEAR(rod.angular_velocity.z(), speed, 1e-12);
        EXPECT_NEAR(angle_of(rod), angle + speed * since, 1e-12);
        const Vec3 along(std::sin(angle), -std::cos(angle), 0.0);
        const Vec3 velocity = speed * Vec3::UnitZ().cross(0.5 * along);
        const Vec3 fall = 0.5 * since * since * t.forces.gravity();
        EXPECT_LT((rod.position - (0.5 * along + since * velocity + fall)).norm(), 1e-12);
        EXPECT_NEAR(t.energy(), energy, 1e-12);
    }
}

// A chain that swings and breaks in its middle: momentum and energy of both pieces, and the same time at any step.
TEST(TreeFlight, PiecesFlyOnAfterABreak) {
    const auto run_at = [](int rate) {
        SceneDescription scene = double_pendulum_scene(1);
        for (int i = 2; i < 4; ++i) {
            add_box(scene, {1.0, 0.1, 0.1}, {0.5 + i, 0.0, 0.0});
            add_joint(scene, JointType::hinge, std::size_t(i - 1), std::size_t(i), double(i) * Vec3::UnitX(),
                      Vec3::UnitZ());
        }
        scene.joints[2].break_force = 25.0;
        TreeScene t(scene);
        const double energy = t.energy();
        Vec3 before = Vec3::Zero();
        while (!t.list[2]->broken) {
            before = t.momentum();
            EXPECT_EQ(t.step(1.0 / rate), Outcome::flown);
            EXPECT_LT(t.time, 3.0);
            const Vec3 given = t.list[0]->account.step.reaction.force + 4.0 / rate * t.forces.gravity();
            EXPECT_LT((t.momentum() - before - given).norm(), 1e-13);
        }
        EXPECT_NEAR(t.energy(), energy, 1e-11);
        t.joints.end_step();
        return t.list[2]->broken_at;
    };
    const double time = run_at(60);
    EXPECT_GT(time, 0.1);
    EXPECT_NEAR(run_at(250), time, 1e-11);
}

// A ball of ten thousand and of a million times the mass of its links, which swing fast under tension: evaluations in
// proportion to that rate where the error can be reached, and no more where rounding hides it.
TEST(TreeFlight, LightLinksBetweenHeavyBodies) {
    for (const double mass : {1e4, 1e6}) {
        SceneDescription scene;
        const Vec3 along(0.5, -std::sqrt(0.75), 0.0);
        for (std::size_t i = 0; i < 5; ++i) {
            add_box(scene, {0.02, 0.1, 0.02}, (0.05 + 0.1 * double(i)) * along).rotation =
                turn(Vec3::UnitZ(), pi / 6.0);
            add_joint(scene, JointType::ball, i == 0 ? std::nullopt : std::optional<std::size_t>(i - 1), i,
                      0.1 * double(i) * along);
        }
        add_sphere(scene, 0.2, 0.7 * along).mass = mass;
        add_joint(scene, JointType::ball, 4, 5, 0.5 * along);
        TreeScene t(scene);
        const double energy = t.energy();
        for (int k = 0; k < 20; ++k) {
            const Outcome outcome = t.step(1.0 / 960.0);
            EXPECT_LT(t.flight.evaluations(), 30000);
            if (mass > 1e5 && outcome == Outcome::declined) break;
            ASSERT_EQ(outcome, Outcome::flown);
            EXPECT_NEAR(t.energy(), energy, 1e-11 * std::abs(energy));
        }
    }
}

// Fast turns in long steps: more parts of a step, and whole turns counted.
TEST(TreeFlight, FastTurns) {
    for (const IntegratorKind method : {IntegratorKind::exact, IntegratorKind::runge_kutta_4}) {
        SceneDescription scene = empty_scene();
        add_box(scene, {1.0, 0.1, 0.1}, Vec3::Zero()).angular_velocity = {0.0, 0.0, 1e4};
        add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitZ());
        TreeScene hinge(scene);
        for (int k = 0; k < 60; ++k) ASSERT_EQ(hinge.step(1.0 / 60.0, method), Outcome::flown);
        EXPECT_NEAR(hinge.list[0]->value[3], 1e4, 1e-6);
        scene = empty_scene();
        BodyDescription& box = add_box(scene, {1.0, 0.1, 0.1}, {0.5, 0.0, 0.0});
        box.angular_velocity = {300.0, 20.0, 10.0};
        box.velocity = box.angular_velocity.cross(box.position);
        add_joint(scene, JointType::ball, std::nullopt, 0, Vec3::Zero());
        TreeScene ball(scene);
        const double energy = ball.energy();
        for (int k = 0; k < 60; ++k) ASSERT_EQ(ball.step(1.0 / 60.0, method), Outcome::flown);
        EXPECT_NEAR(ball.energy(), energy, (method == IntegratorKind::exact ? 1e-11 : 0.05) * energy);
    }
}

// By extrapolation and by Verlet's method: the same motion and the same forces, for each type and both orders of the
// bodies.
TEST(TreeFlight, MethodsAgree) {
    for (const JointType type : {JointType::fixed, JointType::hinge, JointType::ball, JointType::slider,
                                 JointType::universal, JointType::cylindrical, JointType::planar, JointType::six_dof})
        for (const bool swapped : {false, true}) {
            SceneDescription scene;
            add_box(scene, {0.4, 0.2, 0.3}, {0.0, 0.0, 0.0}, 2.0).rotation = turn(Vec3(1.0, 2.0, 3.0), 0.4);
            add_box(scene, {0.3, 0.1, 0.2}, {0.6, 0.1, 0.0}, 1.0).rotation = turn(Vec3(-1.0, 2.0, 1.0), 0.9);
            scene.bodies[0].angular_velocity = {1.0, 2.0, -1.0};
            scene.bodies[1].velocity = {0.1, -0.4, 0.3};
            JointDescription& joint =
                add_joint(scene, type, swapped ? 1 : 0, swapped ? 0 : 1, {0.3, 0.05, 0.0}, {1.0, 0.4, -0.3});
            if (type == JointType::six_dof)
                for (JointAxis* axis : {&joint.move[0], &joint.move[2], &joint.turn[0], &joint.turn[1]})
                    axis->motion = JointAxis::Motion::free;
            const auto run_with = [&](IntegratorKind kind, int steps) {
                scene.simulation.integrator = kind;
                scene.simulation.steps_per_frame = steps;
                World world(scene);
                run(world, scene, 0.5);
                return std::pair(world.snapshot(), world.joint_states()[0]);
            };
            const auto tree = run_with(IntegratorKind::exact, 16), verlet = run_with(IntegratorKind::splitting, 16);
            for (std::size_t i = 0; i < 2; ++i) {
                const BodyState &a = tree.first.bodies[i], &b = verlet.first.bodies[i];
                EXPECT_LT((a.center_of_mass - b.center_of_mass).norm(), 1e-9);
                EXPECT_LT((a.angular_velocity - b.angular_velocity).norm(), 1e-8);
            }
            EXPECT_LT((tree.second.force - verlet.second.force).norm(), 1e-7);
            EXPECT_LT((tree.second.torque - verlet.second.torque).norm(), 1e-7);
        }
}

// The same bytes for any number of threads.
TEST(TreeFlight, ThreadsDoNotChangeAByte) {
    SceneDescription scene;
    for (int c = 0; c < 12; ++c)
        for (int i = 0; i < 4; ++i) {
            BodyDescription& box = add_box(scene, {0.2, 0.1, 0.1}, {0.25 * i, 0.0, 3.0 * c});
            box.integrator = c % 2 ? IntegratorKind::exact : IntegratorKind::runge_kutta_4;
            const std::size_t body = scene.bodies.size() - 1;
            if (i > 0)
                add_joint(scene, JointType::ball, body - 1, body, {0.25 * i - 0.125, 0.0, 3.0 * c});
            else
                add_joint(scene, JointType::hinge, std::nullopt, body, {0.0, 0.2 + 0.01 * c, 3.0 * c}, Vec3::UnitZ());
        }
    World one(scene, 1), four(scene, 4);
    for (int frame = 0; frame < 30; ++frame) {
        one.advance_frame();
        four.advance_frame();
    }
    const Snapshot a = one.snapshot(), b = four.snapshot();
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        EXPECT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass);
        EXPECT_EQ(a.bodies[i].orientation.coeffs(), b.bodies[i].orientation.coeffs());
    }
}

}  // namespace
}  // namespace tumble::tree_flight_test
