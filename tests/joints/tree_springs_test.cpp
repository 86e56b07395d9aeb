// Springs and dampers of trees in flight against the damped oscillator's closed form, alone and in worlds.
#include "tree_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::tree_springs_test {
namespace {

using namespace testing;
using Outcome = TreeFlight::Outcome;

struct Oscillator {
    double stiffness, damping, mass, start;

    // From rest at `start`, m x'' + c x' + k x = 0: x and x'.
    std::pair<double, double> at(double t) const {
        const double half = 0.5 * damping / mass, square = stiffness / mass - half * half;
        const double decay = start * std::exp(-half * t);
        if (square > 0.0) {
            const double w = std::sqrt(square);
            return {decay * (std::cos(w * t) + half / w * std::sin(w * t)),
                    -decay * stiffness / mass / w * std::sin(w * t)};
        }
        const double w = std::sqrt(-square);
        return {decay * (std::cosh(w * t) + half / w * std::sinh(w * t)),
                -decay * stiffness / mass / w * std::sinh(w * t)};
    }
};

/// A box on a hinge about its center (inertia 0.13 kg m^2), or on a slider along z (2 kg), without gravity.
SceneDescription sprung_scene(JointType type, const Oscillator& spring, bool swapped) {
    SceneDescription scene = empty_scene(1);
    scene.simulation.integrator = IntegratorKind::exact;
    scene.simulation.sleep = false;
    add_box(scene, {0.8, 0.374165738677394139, 0.3}, Vec3::Zero(), 2.0);
    const std::optional<std::size_t> world, body = 0;
    JointDescription& joint =
        add_joint(scene, type, swapped ? body : world, swapped ? world : body, Vec3::Zero(), Vec3::UnitZ());
    JointSpring law;
    law.stiffness = spring.stiffness;
    law.damping = spring.damping;
    law.rest = swapped ? spring.start : -spring.start;
    (type == JointType::hinge ? joint.turn[0] : joint.move[0]).spring = law;
    return scene;
}

double deflection(const Body& body, JointType type) {
    if (type == JointType::slider) return body.position.z();
    const Vec3 d = body.orientation * Vec3::UnitX();
    return std::atan2(d.y(), d.x());
}

TEST(TreeSprings, DampedOscillatorsKeepTheirClosedForm) {
    for (const JointType type : {JointType::hinge, JointType::slider})
        for (const bool swapped : {false, true})
            for (const double damping : {0.0, 0.4, 8.0}) {
                const Oscillator law{40.0, damping, type == JointType::hinge ? 0.13 : 2.0, 0.7};
                TreeScene t(sprung_scene(type, law, swapped));
                for (int k = 1; k <= 60; ++k) {
                    ASSERT_EQ(t.step(1.0 / 60.0), Outcome::flown);
                    const auto [value, speed] = law.at(k / 60.0);
                    const Body& body = t.set.bodies[0];
                    EXPECT_NEAR(deflection(body, type), value - law.start, 1e-12) << damping;
                    EXPECT_NEAR(type == JointType::hinge ? body.angular_velocity.z() : body.velocity.z(), speed, 1e-11);
                }
            }
}

// Far stiffer than a step of 1/60 s resolves: parts of a step follow it.
TEST(TreeSprings, AStiffSpringIsFollowed) {
    const Oscillator law{1.3e5, 0.0, 0.13, 0.01};  // 1000 rad/s
    TreeScene t(sprung_scene(JointType::hinge, law, false));
    for (int k = 1; k <= 30; ++k) ASSERT_EQ(t.step(1.0 / 60.0), Outcome::flown);
    EXPECT_NEAR(deflection(t.set.bodies[0], JointType::hinge), law.at(0.5).first - law.start, 1e-11);
}

// In worlds of both modes: the energy that leaves is the heat of the damper.
TEST(TreeSprings, TheHeatOfADamperIsTheEnergyThatLeaves) {
    for (const ImpactMode mode : {ImpactMode::stepped, ImpactMode::exact}) {
        SceneDescription scene = pendulum_scene(1.2, 2);
        scene.simulation.impacts = mode;
        scene.simulation.integrator = IntegratorKind::exact;
        JointSpring law;
        law.stiffness = 3.0;
        law.damping = 0.2;
        scene.joints[0].turn[0].spring = law;
        World world(scene);
        world.record_contacts();
        const auto total = [&] {
            const Measurement m = world.measure();
            return m.kinetic + m.potential + m.elastic + world.contact_records().energy.joint_heat;
        };
        const double start = total();
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            EXPECT_NEAR(total(), start, 1e-12);
        }
        EXPECT_GT(world.contact_records().energy.joint_heat, 0.5);
    }
}

// A ball's spring is not along one coordinate: rows move it.
TEST(TreeSprings, SpringsOfBallsAreDeclined) {
    SceneDescription scene = pendulum_scene(0.5 * std::numbers::pi);
    scene.joints[0].type = JointType::ball;
    for (JointAxis& axis : scene.joints[0].turn) axis.motion = JointAxis::Motion::free;
    EXPECT_EQ(TreeScene(scene).step(1.0 / 60.0), Outcome::flown);
    for (JointAxis& axis : scene.joints[0].turn) axis.spring = JointSpring{};
    EXPECT_EQ(TreeScene(scene).step(1.0 / 60.0), Outcome::declined);
}

}  // namespace
}  // namespace tumble::tree_springs_test
