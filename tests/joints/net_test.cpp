// Nets, which are solved in sweeps: against the direct solver, and by conservation laws.
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::net_test {
using namespace tumble::testing;

namespace {

enum class Links { balls, rods, ropes };

std::size_t place_in(int side, int row, int column) { return std::size_t(row * side + column); }

constexpr double upright = -1.0;  // in place of a height: the first row is the highest

// A net of balls of 1 kg, 0.5 m apart, horizontal at height y or upright: on ball joints halfway, or with distance
// joints between the centers. Bodies and joints come first.
SceneDescription net_scene(int side, Links links, double y = 0.0, int steps_per_frame = 4) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.contact_solver = ContactSolverChoice::soft;
    const double apart = 0.5;
    const auto at = [&](int row, int column) {
        if (y == upright) return Vec3(apart * column, -apart * row, 0.0);
        return Vec3(apart * (column - 0.5 * (side - 1)), y, apart * (row - 0.5 * (side - 1)));
    };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) add_sphere(scene, 0.2, at(row, column));
    const auto join = [&](int row, int column, int to_row, int to_column) {
        const Vec3 a = at(row, column), b = at(to_row, to_column);
        const bool distance = links != Links::balls;
        JointDescription& joint =
            add_joint(scene, distance ? JointType::distance : JointType::ball, place_in(side, row, column),
                      place_in(side, to_row, to_column), 0.5 * (a + b));
        if (!distance) return;
        joint.anchor_first.setZero();
        joint.anchor_second.setZero();
        joint.length = apart;
        if (links == Links::rods) return;
        joint.move[0].motion = JointAxis::Motion::limited;
        joint.move[0].lower = 0.0;
        joint.move[0].upper = apart;
    };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            if (row > 0) join(row - 1, column, row, column);
            if (column > 0) join(row, column - 1, row, column);
        }
    return scene;
}

// Holds the first `count` balls of a row of `every`-th ones to the world.
void hold(SceneDescription& scene, int count, int every) {
    for (int k = 0; k < count; ++k) {
        const auto body = std::size_t(k * every);
        add_joint(scene, JointType::ball, std::nullopt, body, scene.bodies[body].position);
    }
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

// Largest distance of two ball centers of a joint beyond the rope's length.
double stretch_of(const World& world, const SceneDescription& scene) {
    const Snapshot s = world.snapshot();
    double most = 0.0;
    for (const JointDescription& joint : scene.joints)
        if (joint.type == JointType::distance && joint.first && joint.second)
            most =
                std::max(most, (s.bodies[*joint.second].center_of_mass - s.bodies[*joint.first].center_of_mass).norm() -
                                   joint.length);
    return most;
}

}  // namespace

// A sheet on ball joints swings down from its edge.
TEST(Nets, SwingsAsWithTheDirectSolver) {
    SceneDescription scene = net_scene(8, Links::balls);
    hold(scene, 8, 1);
    World sweeps(scene);
    scene.simulation.contact_solver = ContactSolverChoice::direct;
    World direct(scene);
    double gap = 0.0, direct_gap = 0.0, off = 0.0;
    for (int frame = 0; frame < 40; ++frame) {
        sweeps.advance_frame();
        direct.advance_frame();
        gap = std::max(gap, largest_gap(sweeps));
        direct_gap = std::max(direct_gap, largest_gap(direct));
        const Snapshot a = sweeps.snapshot(), b = direct.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i)
            off = std::max(off, (a.bodies[i].center_of_mass - b.bodies[i].center_of_mass).norm());
    }
    EXPECT_LT(direct_gap, 2e-6);
    EXPECT_LT(gap, 3e-4);
    EXPECT_GT(gap, 1e-9);  // otherwise it was solved directly
    EXPECT_LT(off, 1e-2);  // of 2.9 m
}

// At rest a joint under the tension T is open by leak / rate T d^2 / m: of eight balls 0.2 * 8 * 9.81 / 960^2 = 1.7e-5
// m.
TEST(Nets, HangsAsWithTheDirectSolver) {
    for (const Links links : {Links::balls, Links::rods, Links::ropes}) {
        SceneDescription scene = net_scene(8, links, upright);
        scene.simulation.sleep = false;
        hold(scene, 8, 1);
        World sweeps(scene);
        scene.simulation.contact_solver = ContactSolverChoice::direct;
        World direct(scene);
        run(sweeps, scene, 2.0);
        run(direct, scene, 0.05);
        const Snapshot a = sweeps.snapshot(), b = direct.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i)
            EXPECT_LT((a.bodies[i].center_of_mass - b.bodies[i].center_of_mass).norm(), 3e-4) << i;
        EXPECT_LT(std::max(largest_gap(sweeps), stretch_of(sweeps, scene)), 6e-5);
        EXPECT_LT(std::max(largest_gap(direct), stretch_of(direct, scene)), 1e-9);
        // The joints of the upper row carry the net.
        double load = 0.0;
        for (const JointState& joint : sweeps.joint_states()) load += joint.force.y();
        EXPECT_NEAR(load, 64.0 * 9.81 * 4.5, 64.0) << int(links);
    }
}

TEST(Nets, AFreeNetKeepsItsMomenta) {
    for (const Links links : {Links::balls, Links::rods}) {
        SceneDescription scene = net_scene(8, links);
        scene.simulation.gravity.setZero();
        for (BodyDescription& body : scene.bodies) {
            const Vec3 spin(0.3, 2.0, -0.2);
            body.velocity = Vec3(1.0, 0.5, -2.0) + spin.cross(body.position);
            body.angular_velocity = spin;
        }
        scene.bodies[5].velocity.y() += 6.0;
        World world(scene);
        const auto start = momenta_of(world);
        const double energy = total_energy(world);
        double most = energy;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            most = std::max(most, total_energy(world));
        }
        const auto end = momenta_of(world);
        EXPECT_LT((end.first - start.first).norm(), 1e-11);
        EXPECT_LT((end.second - start.second).norm(), 1e-10);
        EXPECT_LT(most, energy * (1.0 + 1e-9));
        EXPECT_GT(total_energy(world), 0.8 * energy);
        EXPECT_LT(largest_gap(world), 2e-3);
    }
}

TEST(Nets, ASwingingNetGainsNoEnergy) {
    for (const int steps : {1, 8}) {
        SceneDescription scene = net_scene(10, Links::rods, 0.0, steps);
        hold(scene, 2, 9);
        World world(scene);
        double most = 0.0, fastest = 0.0;
        for (int frame = 0; frame < 120; ++frame) {
            world.advance_frame();
            const Measurement m = world.measure();
            most = std::max(most, m.kinetic + m.potential);
            fastest = std::max(fastest, m.kinetic);
        }
        EXPECT_LT(most, 1e-3 * fastest);
        EXPECT_GT(fastest, 100.0);
    }
}

TEST(Nets, FallsAsleep) {
    for (const Links links : {Links::balls, Links::ropes}) {
        SceneDescription scene = net_scene(8, links, upright);
        hold(scene, 8, 1);
        World world(scene);
        run(world, scene, 6.0);
        const Snapshot s = world.snapshot();
        const auto awake = [](const BodyState& body) { return !body.asleep; };
        EXPECT_EQ(std::count_if(s.bodies.begin(), s.bodies.end(), awake), 0) << int(links);
    }
}

// Contacts and ropes are solved together: the net lies on a ball, not in it, and is not torn.
TEST(Nets, OfRopesLiesOnABall) {
    SceneDescription scene = net_scene(9, Links::ropes, 1.45, 8);
    BodyDescription& ball = add_sphere(scene, 1.0, Vec3(0.0, 0.0, 0.0));
    ball.type = BodyType::fixed;
    ball.friction = 0.5;
    World world(scene);
    double stretch = 0.0, inside = 0.0;
    for (int frame = 0; frame < 90; ++frame) {
        world.advance_frame();
        stretch = std::max(stretch, stretch_of(world, scene));
        for (std::size_t i = 0; i < 81; ++i)
            inside = std::max(inside, 1.2 - world.snapshot().bodies[i].center_of_mass.norm());
    }
    EXPECT_LT(inside, 4e-3);
    EXPECT_LT(stretch, 5e-3);
    EXPECT_GT(stretch, 0.0);
    EXPECT_LT(world.snapshot().bodies[0].center_of_mass.y(), 0.7);
}

// Many blocks of bodies: threads share one island.
TEST(Nets, HasTheSameBytesForAnyThreads) {
    SceneDescription scene = net_scene(30, Links::balls, 0.0, 1);
    hold(scene, 2, 29);
    World one(scene, 1), two(scene, 2);
    for (int frame = 0; frame < 20; ++frame) {
        one.advance_frame();
        two.advance_frame();
    }
    const Snapshot a = one.snapshot(), b = two.snapshot();
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        EXPECT_EQ(a.bodies[i].momentum, b.bodies[i].momentum) << i;
        EXPECT_EQ(a.bodies[i].center_of_mass, b.bodies[i].center_of_mass) << i;
    }
    EXPECT_LT(a.bodies[899].center_of_mass.y(), -0.01);
}

TEST(Nets, FollowsAKinematicBody) {
    SceneDescription scene = net_scene(8, Links::balls);
    scene.bodies[0].type = BodyType::kinematic;
    const Vec3 start = scene.bodies[0].position;
    scene.bodies[0].keyframes = {{0.0, start, Quat::Identity()},
                                 {1.0, start + Vec3(1.0, 0.5, 0.0), turn(Vec3::UnitY(), 1.0)}};
    World world(scene);
    double gap = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
        world.advance_frame();
        gap = std::max(gap, largest_gap(world));
    }
    EXPECT_LT(gap, 6e-3);  // it starts with a jerk
    EXPECT_GT(gap, 1e-8);
}

// The way follows from the joints: large nets, nets of ropes, and neither with joints that sweeps do not know.
TEST(Nets, AreFoundByTheirJoints) {
    const auto sweeps = [](SceneDescription scene) {
        scene.simulation.contact_solver = ContactSolverChoice::by_island;
        return World(scene).joint_report().swept();
    };
    EXPECT_EQ(sweeps(net_scene(8, Links::balls)), 0u);
    EXPECT_EQ(sweeps(net_scene(30, Links::balls)), 1u);
    EXPECT_EQ(sweeps(net_scene(8, Links::ropes)), 1u);
    SceneDescription other = net_scene(8, Links::ropes);
    other.joints[3].break_force = 10.0;
    EXPECT_EQ(sweeps(other), 0u);
    other = net_scene(8, Links::ropes);
    other.bodies[3].integrator = IntegratorKind::splitting;
    EXPECT_EQ(sweeps(other), 0u);
    other = net_scene(8, Links::ropes);
    other.bodies[3].mass = 100.0;
    EXPECT_EQ(sweeps(other), 0u);
    other = net_scene(8, Links::ropes);
    other.simulation.impacts = ImpactMode::exact;
    EXPECT_EQ(sweeps(other), 0u);
}

}  // namespace tumble::net_test
