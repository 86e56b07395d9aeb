// Joints that lock or limit turns, solved in sweeps: against closed forms, the direct solver, and by conservation laws.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::sweep_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

void add_floor(SceneDescription& scene) {
    BodyDescription& floor = add_body(scene, PlaneShape{}, Vec3::Zero());
    floor.type = BodyType::fixed;
    floor.friction = 0.5;
    floor.restitution = 0.0;
}

SceneDescription swept(SceneDescription scene) {
    scene.simulation.contact_solver = ContactSolverChoice::soft;
    return scene;
}

void limit_turn(JointAxis& axis, double lower, double upper) {
    axis.motion = JointAxis::Motion::limited;
    axis.lower = lower;
    axis.upper = upper;
}

// A trunk with a limb of each kind: hinge, weld, universal joint, and ball within a cone and limits of twist.
SceneDescription figure_scene(int steps_per_frame) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    add_box(scene, {0.4, 0.3, 0.2}, Vec3::Zero(), 4.0);
    const auto limb = [&](JointType type, const Vec3& way, const Vec3& axis) -> JointDescription& {
        add_box(scene, Vec3(0.1, 0.1, 0.1) + 0.4 * way.cwiseAbs(), 0.5 * way, 1.0);
        return add_joint(scene, type, 0, scene.bodies.size() - 1, 0.22 * way, axis);
    };
    limit_turn(limb(JointType::hinge, Vec3::UnitX(), Vec3::UnitZ()).turn[0], -0.5, 1.0);
    limb(JointType::fixed, -Vec3::UnitX(), Vec3::UnitX());
    limb(JointType::universal, Vec3::UnitY(), Vec3::UnitX());
    JointDescription& ball = limb(JointType::ball, -Vec3::UnitY(), -Vec3::UnitY());
    ball.swing = {0.6, 0.6};
    limit_turn(ball.turn[0], -0.4, 0.4);
    return scene;
}

double total_energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

std::pair<Vec3, Vec3> momenta_of(const World& world) {
    std::pair<Vec3, Vec3> sum{Vec3::Zero(), Vec3::Zero()};
    for (const BodyState& body : world.snapshot().bodies) {
        sum.first += body.momentum;
        sum.second += body.angular_momentum + body.center_of_mass.cross(body.momentum);
    }
    return sum;
}

// Largest angle between the twist axes of a ball's frames.
double swing_of(const World& world, const JointDescription& joint) {
    const Snapshot s = world.snapshot();
    const auto axis = [&](std::size_t body, const Quat& frame) {
        return Vec3(s.bodies[body].orientation * (frame * Vec3::UnitX()));
    };
    const Vec3 a = axis(*joint.first, joint.frame_first), b = axis(*joint.second, joint.frame_second);
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Joint frames are given from the body's origin, which is the center of mass of a box.
double twist_of(const World& world, std::size_t joint) { return world.joint_states()[joint].position[3]; }

}  // namespace

// T = 4 sqrt(2 l / (3 g)) K(sin(a / 2)) of a rod that swings by a = 60 degrees: K(1/2) = 1.68575035481260.
TEST(SweptTurns, ARodSwingsOnAHinge) {
    SceneDescription scene = swept(pendulum_scene(std::numbers::pi / 3.0));
    scene.simulation.gravity.z() = 3.0;  // the hinge carries it
    World world(scene);
    const double quarter = std::sqrt(2.0 / (3.0 * g)) * 1.68575035481260;
    double low = 0.0, gap = 0.0;
    for (int step = 1; step <= 960 && low == 0.0; ++step) {
        world.step();
        gap = std::max(gap, largest_gap(world));
        if (world.snapshot().bodies[0].center_of_mass.x() < 0.0) low = step / 960.0;
    }
    EXPECT_NEAR(low, quarter, 3e-3);
    EXPECT_LT(gap, 1e-4);
    EXPECT_GT(gap, 1e-12);  // else it was solved directly
    EXPECT_LT(std::abs(world.snapshot().bodies[0].center_of_mass.z()), 1e-4);
}

// A chain of eight plates on hinges swings down from its end, in sweeps as with the direct solver.
TEST(SweptTurns, AHingeChainSwingsAsWithTheDirectSolver) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    scene.simulation.sleep = false;
    scene.simulation.gravity.z() = 1.0;  // the hinges carry it
    for (int i = 0; i < 8; ++i) {
        add_box(scene, {0.5, 0.1, 0.4}, {0.25 + 0.5 * i, 0.0, 0.0});
        const auto before = i == 0 ? std::optional<std::size_t>{} : std::size_t(i - 1);
        add_joint(scene, JointType::hinge, before, std::size_t(i), {0.5 * i, 0.0, 0.0}, Vec3::UnitZ());
    }
    World sweeps(scene);
    scene.simulation.contact_solver = ContactSolverChoice::direct;
    World direct(scene);
    double off = 0.0, gap = 0.0, across = 0.0;
    for (int frame = 0; frame < 50; ++frame) {
        sweeps.advance_frame();
        direct.advance_frame();
        gap = std::max(gap, largest_gap(sweeps));
        const Snapshot a = sweeps.snapshot(), b = direct.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i) {
            off = std::max(off, (a.bodies[i].center_of_mass - b.bodies[i].center_of_mass).norm());
            across = std::max(across, std::abs(a.bodies[i].center_of_mass.z()));
        }
    }
    EXPECT_LT(off, 0.1);  // of 4 m
    EXPECT_LT(gap, 4e-3);
    EXPECT_GT(gap, 1e-9);
    EXPECT_LT(across, 1e-2);
}

// Four boxes of 1 kg and 0.5 m, welded to each other and to the world: 4 m g, and the moment 4 m g at 1 m.
TEST(SweptTurns, AWeldedBeamCarriesItsWeight) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    for (int i = 0; i < 4; ++i) {
        add_box(scene, {0.5, 0.2, 0.2}, {0.25 + 0.5 * i, 0.0, 0.0});
        const auto before = i == 0 ? std::optional<std::size_t>{} : std::size_t(i - 1);
        add_joint(scene, JointType::fixed, before, std::size_t(i), {0.5 * i, 0.0, 0.0}, Vec3::UnitX());
    }
    World world(scene);
    run(world, scene, 1.0);
    const JointState joint = world.joint_states()[0];
    EXPECT_NEAR(joint.force.y(), 4.0 * g, 0.02 * 4.0 * g);
    EXPECT_NEAR(joint.torque.z(), 4.0 * g, 0.02 * 4.0 * g);
    EXPECT_LT(largest_gap(world), 1e-4);
    EXPECT_GT(largest_gap(world), 1e-9);
    EXPECT_LT(std::abs(world.snapshot().bodies[3].center_of_mass.y()), 1e-3);
    run(world, scene, 1.0);
    EXPECT_TRUE(world.snapshot().bodies[3].asleep);
}

TEST(SweptTurns, ADoorStopsAtItsLimit) {
    for (const int steps : {1, 8}) {
        SceneDescription scene = swept({});
        scene.simulation.steps_per_frame = steps;
        scene.simulation.gravity.setZero();
        scene.simulation.sleep = false;
        BodyDescription& door = add_box(scene, {0.9, 2.0, 0.04}, {0.45, 0.0, 0.0}, 20.0);
        door.angular_velocity = {0.0, 3.0, 0.0};
        door.velocity = door.angular_velocity.cross(door.position);
        limit_turn(add_joint(scene, JointType::hinge, std::nullopt, 0, Vec3::Zero(), Vec3::UnitY()).turn[0], -1.0, 1.0);
        World world(scene);
        double farthest = 0.0;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            farthest = std::max(farthest, twist_of(world, 0));
        }
        EXPECT_LT(farthest, 1.0 + 2e-3);
        EXPECT_NEAR(twist_of(world, 0), 1.0, 2e-3);
        EXPECT_LT(world.measure().kinetic, 1e-4);
    }
}

// A rod falls on a ball joint until its axis is 0.5 rad from the vertical, and moves round along the cone's border.
TEST(SweptTurns, AConeAndATwistHold) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 4;
    scene.simulation.sleep = false;
    BodyDescription& base = add_box(scene, {0.2, 0.2, 0.2}, Vec3::Zero());
    base.type = BodyType::fixed;
    BodyDescription& rod = add_box(scene, {0.1, 1.0, 0.2}, {0.0, 0.5, 0.0});
    rod.angular_velocity = {1.0, 8.0, 0.5};
    rod.velocity = rod.angular_velocity.cross(rod.position);
    JointDescription& ball = add_joint(scene, JointType::ball, 0, 1, Vec3::Zero(), Vec3::UnitY());
    ball.swing = {0.5, 0.5};
    limit_turn(ball.turn[0], -0.3, 0.2);
    World world(scene);
    double swing = 0.0, twist = 0.0, other = 0.0;
    for (int frame = 0; frame < 120; ++frame) {
        world.advance_frame();
        swing = std::max(swing, swing_of(world, scene.joints[0]));
        twist = std::max(twist, twist_of(world, 0));
        other = std::min(other, twist_of(world, 0));
    }
    EXPECT_LT(swing, 0.5 + 5e-3);
    EXPECT_GT(swing, 0.5);
    EXPECT_NEAR(twist, 0.2, 2e-3);
    EXPECT_GT(other, -0.3 - 2e-3);
    EXPECT_NEAR(swing_of(world, scene.joints[0]), 0.5, 2e-3);
    EXPECT_LT(largest_gap(world), 1e-3);
}

// Both angles turn by a radian and more; the third direction stays locked.
TEST(SweptTurns, AUniversalJointTurnsAboutBothAxes) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    scene.simulation.gravity.setZero();
    BodyDescription& plate = add_box(scene, {0.8, 0.6, 0.1}, Vec3::Zero());
    plate.angular_velocity = {3.0, 2.0, 0.0};
    add_joint(scene, JointType::universal, std::nullopt, 0, Vec3::Zero(), Vec3::UnitX());
    World world(scene);
    double gap = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
    }
    EXPECT_LT(gap, 1e-3);
    EXPECT_GT(gap, 1e-10);
    const JointState joint = world.joint_states()[0];
    EXPECT_GT(std::abs(joint.position[3]), 1.0);
    EXPECT_GT(std::abs(joint.position[4]), 1.0);
    EXPECT_GT(world.measure().kinetic, 0.9 * 0.5 * (0.0308333 * 9.0 + 0.0541667 * 4.0));
}

TEST(SweptTurns, AFreeFigureKeepsItsMomentaAndGainsNoEnergy) {
    for (const int steps : {8, 16}) {
        SceneDescription scene = swept(figure_scene(steps));
        scene.simulation.gravity.setZero();
        for (BodyDescription& body : scene.bodies) {
            const Vec3 spin(0.5, 3.0, -1.0);
            body.velocity = Vec3(1.0, 0.5, -2.0) + spin.cross(body.position);
            body.angular_velocity = spin;
        }
        scene.bodies[1].velocity.y() += 3.0;
        scene.bodies[4].velocity.z() += 4.0;
        scene.bodies[4].angular_velocity.y() += 6.0;
        World world(scene);
        const auto start = momenta_of(world);
        double energy = total_energy(world);
        const double first = energy;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            EXPECT_LT(total_energy(world), energy * (1.0 + 1e-9) + 0.01 * energy);
            energy = std::min(energy, total_energy(world));
        }
        const auto end = momenta_of(world);
        EXPECT_LT((end.first - start.first).norm(), 1e-12);
        EXPECT_LT((end.second - start.second).norm(), 1e-11);
        EXPECT_GT(energy, 0.5 * first);
        EXPECT_LT(largest_gap(world), 2e-3);
        EXPECT_GT(largest_gap(world), 1e-9);
    }
}

// I w' = -C w, and I w' = -tau: exp(-t C / I), and 1 - t tau / (I w) of the speed.
TEST(SweptTurns, DampersAndFrictionSlowARotor) {
    for (const bool ball : {false, true})
        for (const bool damper : {false, true}) {
            SceneDescription scene = swept({});
            scene.simulation.steps_per_frame = 8;
            scene.simulation.gravity.setZero();
            const double inertia = 0.1 * 4.0 * 0.5 * 0.5;  // 2/5 m r^2
            BodyDescription& rotor = add_sphere(scene, 0.5, Vec3::Zero(), 1.0);
            const Vec3 axis = ball ? Vec3(2.0, -1.0, 2.0) / 3.0 : Vec3(Vec3::UnitZ());
            rotor.angular_velocity = 10.0 * axis;
            JointDescription& joint = add_joint(scene, ball ? JointType::ball : JointType::hinge, std::nullopt, 0,
                                                Vec3::Zero(), Vec3::UnitZ());
            if (damper) {
                joint.turn[0].spring.emplace();
                joint.turn[0].spring->damping = 0.05;
            } else {
                joint.turn[0].friction = 0.5;
            }
            World world(scene);
            run(world, scene, 1.0);
            const Vec3 left = world.snapshot().bodies[0].angular_velocity;
            const double expected = damper ? 10.0 * std::exp(-0.05 / inertia) : 10.0 - 0.5 / inertia;
            EXPECT_NEAR(left.dot(axis), expected, 0.01 * expected) << ball << damper;
            EXPECT_LT(left.cross(axis).norm(), 1e-4);
            EXPECT_NEAR(world.joint_states()[0].torque.dot(axis), damper ? -0.05 * expected : -0.5, 0.01);
            run(world, scene, 2.0);
            const double late = damper ? 10.0 * std::exp(-0.15 / inertia) : 0.0;
            EXPECT_NEAR(world.snapshot().bodies[0].angular_velocity.norm(), late, 0.03 * late + 1e-6);
        }
}

// Figures that lie in a heap fall asleep, and their joints have stayed closed.
TEST(SweptTurns, AHeapOfFiguresFallsAsleep) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 4;
    for (int k = 0; k < 4; ++k) {
        const SceneDescription figure = figure_scene(4);
        const std::size_t first = scene.bodies.size();
        const Quat q = turn(Vec3(1.0, 0.3 * k, -0.5).normalized(), 0.7 * k);
        for (BodyDescription body : figure.bodies) {
            body.position = q * body.position + Vec3(0.3 * k, 0.9 + 0.9 * k, 0.2 * (k % 2));
            body.rotation = q;
            body.friction = 0.5;
            body.restitution = 0.0;
            scene.bodies.push_back(body);
        }
        for (JointDescription joint : figure.joints) {
            *joint.first += first;
            *joint.second += first;
            joint.name += std::to_string(k);
            if (joint.type == JointType::hinge || joint.type == JointType::ball) joint.turn[0].friction = 0.02;
            if (joint.type == JointType::universal)
                for (const std::size_t axis : {0u, 1u}) joint.turn[axis].spring = JointSpring{.damping = 0.1};
            scene.joints.push_back(joint);
        }
    }
    add_floor(scene);
    World world(scene);
    double gap = 0.0, energy = total_energy(world);
    for (int frame = 0; frame < 480; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
        EXPECT_LT(total_energy(world), energy + 0.05);
        energy = std::min(energy, total_energy(world));
    }
    const Snapshot s = world.snapshot();
    const auto awake = [](const BodyState& body) { return body.mass > 0.0 && !body.asleep; };
    EXPECT_EQ(std::count_if(s.bodies.begin(), s.bodies.end(), awake), 0);
    EXPECT_LT(gap, 1e-2);
    EXPECT_EQ(world.joint_report().by_sweeps, 4u);
}

// A paddle turns by 1.5 rad in a second, and two vanes on hinges and a weld go along.
TEST(SweptTurns, FollowAKinematicBody) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 8;
    BodyDescription& paddle = add_box(scene, {0.4, 0.2, 0.4}, Vec3::Zero());
    paddle.type = BodyType::kinematic;
    paddle.keyframes = {{0.0, Vec3::Zero(), Quat::Identity()}, {1.0, {0.3, 0.2, 0.0}, turn(Vec3::UnitY(), 1.5)}};
    add_box(scene, {0.4, 0.2, 0.1}, {0.4, 0.0, 0.0});
    add_joint(scene, JointType::hinge, 0, 1, {0.2, 0.0, 0.0}, Vec3::UnitY());
    add_box(scene, {0.4, 0.2, 0.1}, {-0.4, 0.0, 0.0});
    add_joint(scene, JointType::fixed, 0, 2, {-0.2, 0.0, 0.0}, Vec3::UnitY());
    World world(scene);
    double gap = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
    }
    EXPECT_LT(gap, 5e-3);
    EXPECT_GT(gap, 1e-8);
    const Vec3 vane = world.snapshot().bodies[2].center_of_mass;
    EXPECT_LT((vane - Vec3(0.3 - 0.4 * std::cos(1.5), 0.2, 0.4 * std::sin(1.5))).norm(), 5e-3);
}

// Fast spins, unlike masses and few steps: finite, and without energy from nothing.
TEST(SweptTurns, AWildFigureStaysFinite) {
    SceneDescription scene = swept(figure_scene(1));
    scene.bodies[0].mass = 100.0;
    scene.bodies[2].mass = 0.05;
    scene.bodies[3].mass = 20.0;
    scene.bodies[1].angular_velocity = {50.0, -80.0, 120.0};
    scene.bodies[3].angular_velocity = {0.0, 60.0, 0.0};
    scene.bodies[4].angular_velocity = {-70.0, 0.0, 200.0};
    scene.bodies[4].velocity = {20.0, 5.0, -30.0};
    for (BodyDescription& body : scene.bodies) body.position.y() += 1.0;
    add_floor(scene);
    World world(scene);
    const double start = total_energy(world);
    double most = start;
    for (int frame = 0; frame < 240; ++frame) {
        world.advance_frame();
        most = std::max(most, total_energy(world));
    }
    EXPECT_LT(most, 1.001 * start);
    EXPECT_LT(largest_gap(world), 0.1);
}

TEST(SweptTurns, HaveTheSameBytesForAnyThreads) {
    SceneDescription scene = swept({});
    scene.simulation.steps_per_frame = 1;
    for (int k = 0; k < 160; ++k) {
        const SceneDescription figure = figure_scene(1);
        const std::size_t first = scene.bodies.size();
        for (BodyDescription body : figure.bodies) {
            body.position += Vec3(0.9 * (k % 16), 0.8, 0.9 * (k / 16));
            body.angular_velocity = {0.1 * k, 1.0, 0.3};
            scene.bodies.push_back(body);
        }
        for (JointDescription joint : figure.joints) {
            *joint.first += first;
            *joint.second += first;
            joint.name += std::to_string(k);
            scene.joints.push_back(joint);
        }
    }
    add_floor(scene);
    World one(scene, 1), two(scene, 2);
    for (int frame = 0; frame < 40; ++frame) {
        one.advance_frame();
        two.advance_frame();
    }
    const Snapshot a = one.snapshot(), b = two.snapshot();
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        EXPECT_EQ(a.bodies[i].momentum, b.bodies[i].momentum) << i;
        EXPECT_EQ(a.bodies[i].orientation.coeffs(), b.bodies[i].orientation.coeffs()) << i;
    }
}

// Which groups the sweeps take where they are asked to take all.
TEST(SweptTurns, LeaveOtherJointsToTheDirectSolver) {
    const auto by_sweeps = [](auto&& change) {
        SceneDescription scene = swept(figure_scene(4));
        change(scene);
        return World(scene).joint_report().by_sweeps;
    };
    EXPECT_EQ(by_sweeps([](SceneDescription&) {}), 1u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].friction = 0.1; }), 1u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].spring = JointSpring{.damping = 0.1}; }), 1u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].spring = JointSpring{.stiffness = 1.0}; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].restitution = 0.5; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[0].turn[0].motor.emplace().speed = 1.0; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[1].break_torque = 10.0; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[1].move[0].motion = JointAxis::Motion::free; }), 0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.joints[2].turn[0].friction = s.joints[2].turn[1].friction = 0.1; }),
              0u);
    EXPECT_EQ(by_sweeps([](SceneDescription& s) { s.simulation.contact_solver = ContactSolverChoice::by_island; }), 0u);
}

}  // namespace tumble::sweep_test
