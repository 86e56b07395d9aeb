// The way in which joined bodies move: each condition of the decision, with a scene on both sides of it.
#include "sim/joints/joint_way.h"
#include "sim/world.h"
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

namespace tumble::joint_way_test {
using namespace tumble::testing;

namespace {

using Change = std::function<void(SceneDescription&)>;

/// Two boxes on a hinge.
SceneDescription pair_scene() {
    SceneDescription scene;
    add_box(scene, {0.2, 0.2, 0.2}, Vec3::Zero(), 1.0);
    add_box(scene, {0.2, 0.2, 0.2}, {0.4, 0.0, 0.0}, 1.0);
    add_joint(scene, JointType::hinge, 0, 1, {0.2, 0.0, 0.0}, Vec3::UnitZ());
    return scene;
}

JointAxis& turn_of(SceneDescription& scene) { return scene.joints[0].turn[0]; }

/// The way of the only group, in flight and beside contacts.
std::pair<JointWay, JointWay> ways(const SceneDescription& scene) {
    const JointReport report = World(scene).joint_report();
    const auto only = [](const std::array<std::size_t, 3>& counts) {
        return JointWay(std::max_element(counts.begin(), counts.end()) - counts.begin());
    };
    EXPECT_EQ(report.groups, 1u);
    return {only(report.in_flight), only(report.in_contact)};
}

}  // namespace

TEST(JointWay, FollowsFromJointsAndIntegrators) {
    const auto flies = [](const Change& change) {
        SceneDescription scene = pair_scene();
        change(scene);
        const auto [flight, contact] = ways(scene);
        EXPECT_EQ(contact, JointWay::direct);
        return flight == JointWay::free;
    };
    EXPECT_TRUE(flies([](SceneDescription&) {}));
    for (const IntegratorKind kind : {IntegratorKind::runge_kutta_4, IntegratorKind::splitting, IntegratorKind::exact})
        EXPECT_TRUE(flies([&](SceneDescription& s) { s.simulation.integrator = kind; }));
    EXPECT_FALSE(flies([](SceneDescription& s) { s.simulation.integrator = IntegratorKind::explicit_euler; }));
    EXPECT_TRUE(flies([](SceneDescription& s) { turn_of(s).friction = 0.1; }));
    EXPECT_FALSE(flies([](SceneDescription& s) { s.joints[0].friction_coefficient = 0.1; }));
    EXPECT_TRUE(flies([](SceneDescription& s) { turn_of(s).spring = JointSpring{.stiffness = 1.0, .damping = 0.1}; }));
    EXPECT_TRUE(flies([](SceneDescription& s) { limit_turn(turn_of(s), -0.5, 0.5); }));
    EXPECT_TRUE(flies([](SceneDescription& s) { s.joints[0].break_force = 10.0; }));
    EXPECT_TRUE(flies([](SceneDescription& s) { s.simulation.contact_solver = ContactSolverChoice::direct; }));
    EXPECT_TRUE(flies([](SceneDescription& s) { s.simulation.impacts = ImpactMode::exact; }));
}

TEST(JointWay, MotorsFlyWithOneTargetOrABoundedSpeed) {
    const auto flies = [](const JointMotor& motor) {
        SceneDescription scene = pair_scene();
        turn_of(scene).motor = motor;
        return ways(scene).first == JointWay::free;
    };
    JointMotor motor;
    motor.targets = {{0.0, 1.0}};
    motor.stiffness = 1.0;
    EXPECT_TRUE(flies(motor));
    motor.targets.push_back({1.0, 2.0});
    EXPECT_FALSE(flies(motor));
    JointMotor turning;
    turning.speed = 1.0;
    EXPECT_FALSE(flies(turning));
    turning.max_force = 2.0;
    EXPECT_TRUE(flies(turning));
}

TEST(JointWay, SoftSolvesAllGroupsInSweepsThatSweepsKnow) {
    SceneDescription scene = swept(pair_scene());
    EXPECT_EQ(ways(scene), std::pair(JointWay::sweeps, JointWay::sweeps));
    turn_of(scene).spring = JointSpring{.stiffness = 1.0};
    EXPECT_EQ(ways(scene), std::pair(JointWay::free, JointWay::direct));
}

// Balls in a square of n x n, on ropes to their neighbors.
TEST(JointWay, NetsOfRopesAreSweptFromSixtyFourBodies) {
    const auto net = [](int n) {
        SceneDescription scene;
        for (int k = 0; k < n * n; ++k) add_sphere(scene, 0.2, 0.5 * Vec3(k % n, 0.0, k / n));
        const auto join = [&](int a, int b) {
            JointDescription& rope =
                add_joint(scene, JointType::distance, std::size_t(a), std::size_t(b), Vec3::Zero());
            rope.anchor_first.setZero();
            rope.anchor_second.setZero();
            rope.length = 0.5;
            rope.move[0].motion = JointAxis::Motion::limited;
            rope.move[0].lower = 0.0;
            rope.move[0].upper = 0.5;
        };
        for (int k = 0; k < n * n; ++k) {
            if (k % n + 1 < n) join(k, k + 1);
            if (k + n < n * n) join(k, k + n);
        }
        return scene;
    };
    const auto way = [](const SceneDescription& scene) { return ways(scene).second; };
    EXPECT_EQ(way(net(8)), JointWay::sweeps);
    EXPECT_EQ(way(net(7)), JointWay::direct);
    SceneDescription heavy = net(8);
    heavy.bodies[0].mass = 100.0;
    EXPECT_EQ(way(heavy), JointWay::direct);
    SceneDescription broken = net(8);
    broken.joints[0].break_force = 1e6;
    EXPECT_EQ(way(broken), JointWay::direct);
    SceneDescription direct = net(8);
    direct.simulation.contact_solver = ContactSolverChoice::direct;
    EXPECT_EQ(way(direct), JointWay::direct);
}

TEST(JointWay, FollowsFromContacts) {
    const MechanismFacts figures{.known_to_sweeps = true, .figures = 60}, net{.known_to_sweeps = true, .net = true},
        mixed{.known_to_sweeps = true, .other = true, .figures = 60},
        unknown{.known_to_sweeps = false, .other = true, .figures = 60},
        strange{.known_to_sweeps = false, .net = true, .other = true}, grounded{.flies = false, .other = true};
    const ContactFacts none, near{.within_reach = true}, touching{.within_reach = true, .touching = true},
        crowd{.within_reach = true, .crowd = true}, far{.crowd = true};
    EXPECT_EQ(choose_way(figures, none), JointWay::free);
    EXPECT_EQ(choose_way(figures, near), JointWay::free);  // a trial
    EXPECT_EQ(choose_way(figures, touching), JointWay::direct);
    EXPECT_EQ(choose_way(figures, crowd), JointWay::sweeps);
    EXPECT_EQ(choose_way(figures, far), JointWay::free);
    for (const MechanismFacts& other : {mixed, unknown}) {
        EXPECT_EQ(choose_way(other, crowd), JointWay::free);
        EXPECT_EQ(choose_way(other, touching), JointWay::direct);
    }
    for (const ContactFacts& contacts : {none, near, touching, crowd}) {
        EXPECT_EQ(choose_way(net, contacts), JointWay::sweeps);
        EXPECT_EQ(choose_way(strange, contacts), JointWay::direct);
        EXPECT_EQ(choose_way(grounded, contacts), JointWay::direct);
    }
}

}  // namespace tumble::joint_way_test
