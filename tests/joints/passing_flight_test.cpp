// Joined bodies that fly past bodies within their reach, without contact: as if they could not collide.
#include "joint_scenes.h"

#include <gtest/gtest.h>

namespace tumble::passing_flight_test {
namespace {

using namespace testing;

/// Boxes of 1, 2, 3, ... kg end to end along +x on ball joints, in space, whirling about z at `rate` rad/s about their
/// center of mass.
SceneDescription whirling_chain(int links, double rate, int steps_per_frame, IntegratorKind integrator) {
    SceneDescription scene = empty_scene();
    scene.simulation.steps_per_frame = steps_per_frame;
    scene.simulation.integrator = integrator;
    scene.simulation.sleep = false;
    double mass = 0.0, moment = 0.0;
    for (int i = 0; i < links; ++i) {
        mass += i + 1.0;
        moment += (i + 1.0) * (0.25 + 0.5 * i);
    }
    for (int i = 0; i < links; ++i) {
        const double x = 0.25 + 0.5 * i;
        BodyDescription& box = add_box(scene, {0.5, 0.1, 0.1}, {x, 0.0, 0.0});
        box.mass = i + 1.0;
        box.velocity = {0.0, rate * (x - moment / mass), 0.0};
        box.angular_velocity = {0.0, 0.0, rate};
    }
    for (int i = 0; i + 1 < links; ++i)
        add_joint(scene, JointType::ball, i, i + 1, {0.5 * (i + 1), 0.0, 0.0}, Vec3::UnitX());
    return scene;
}

struct Ends {
    Measurement start, end;
    double energy() const { return (end.kinetic - start.kinetic) / start.kinetic; }
    double spin() const {
        return (end.angular_momentum - start.angular_momentum).norm() / start.angular_momentum.norm();
    }
};

Ends run(const SceneDescription& scene, int frames, std::size_t* impacts = nullptr) {
    World world(scene);
    world.record_contacts();
    Ends ends{world.measure(), {}};
    for (int frame = 0; frame < frames; ++frame) {
        world.advance_frame();
        if (impacts) *impacts += world.contact_records().impacts.size();
    }
    ends.end = world.measure();
    return ends;
}

TEST(PassingFlight, AWhirlingChainThatCouldTouchItselfKeepsItsMotion) {
    for (const int links : {3, 4, 5})
        for (const int steps_per_frame : {1, 3, 16}) {
            SCOPED_TRACE(fmt::format("{} links, {} steps a frame", links, steps_per_frame));
            std::size_t impacts = 0;
            const Ends exact = run(whirling_chain(links, 30.0, steps_per_frame, IntegratorKind::exact), 20, &impacts);
            EXPECT_NEAR(exact.energy(), 0.0, 1e-12);
            EXPECT_LT(exact.spin(), 1e-12);
            EXPECT_LT(exact.end.momentum.norm(), 1e-11);
            EXPECT_EQ(impacts, 0u);
        }
}

// Speeds that differ from those of a stiff rod bend the chain.
TEST(PassingFlight, ABendingChainKeepsItsEnergyAndTheOrderOfItsIntegrator) {
    const auto bend = [](int steps_per_frame, IntegratorKind kind) {
        SceneDescription scene = whirling_chain(4, 12.0, steps_per_frame, kind);
        scene.bodies[1].velocity.z() += 0.5;
        scene.bodies[3].angular_velocity.z() -= 3.0;
        World world(scene);
        world.advance_frame();  // the velocities fit the joints after a step
        const Measurement start = world.measure();
        for (int frame = 0; frame < 9; ++frame) world.advance_frame();
        EXPECT_EQ(world.measure().contacts, 0);
        return std::pair{world.snapshot().bodies[3].center_of_mass, world.measure().kinetic / start.kinetic - 1.0};
    };
    const auto [exact, gain] = bend(16, IntegratorKind::exact);
    EXPECT_NEAR(gain, 0.0, 1e-11);
    const double coarse = (bend(16, IntegratorKind::symplectic_euler).first - exact).norm(),
                 fine = (bend(64, IntegratorKind::symplectic_euler).first - exact).norm();
    EXPECT_LT(coarse, 2e-2);
    EXPECT_NEAR(coarse / fine, 16.0, 3.0);
}

// A rod on a hinge with a floor below: it passes 1 cm above it, or meets it.
TEST(PassingFlight, APendulumPassesOverAFloorOrMeetsIt) {
    for (const double room : {0.01, -0.01}) {
        SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
        BodyDescription& floor =
            add_body(scene, PlaneShape{Vec3::UnitY(), -std::sqrt(1.0 + 0.05 * 0.05) - room}, Vec3::Zero());
        floor.type = BodyType::fixed;
        floor.friction = 0.0;
        scene.bodies[0].restitution = 0.0;
        World world(scene);
        const double start = world.measure().kinetic + world.measure().potential;
        double deepest = 0.0, farthest = infinity;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            deepest = std::max(deepest, world.measure().max_penetration);
            farthest = std::min(farthest, world.snapshot().bodies[0].center_of_mass.x());
        }
        const double lost = start - world.measure().kinetic - world.measure().potential;
        if (room > 0.0) {
            EXPECT_LT(std::abs(lost), 1e-3);
            EXPECT_LT(farthest, -0.499);  // as high on the other side
        } else {
            EXPECT_GT(lost, 0.1);
            EXPECT_GT(farthest, -0.1);
        }
        EXPECT_LT(deepest, 1e-3);
    }
}

}  // namespace
}  // namespace tumble::passing_flight_test
