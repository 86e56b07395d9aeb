// Andrews' squeezer, IFToMM's A03, of bench/harness/squeezer.h.
#include "harness/squeezer.h"
#include "joint_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::squeezer_test {
using namespace tumble::testing;
namespace squeezer = bench::squeezer;

namespace {

Vec3 at(const squeezer::Point& p, double z = 0.0) { return {p.x, p.y, z}; }

SceneDescription squeezer_scene(int steps) {
    SceneDescription scene = empty_scene();
    scene.output.fps = 1.0 / squeezer::duration;
    scene.simulation.steps_per_frame = steps;
    scene.simulation.sleep = false;
    for (const squeezer::Plate& plate : squeezer::plates()) {
        const Vec3 center = at(plate.center, squeezer::layer * double(scene.bodies.size()));
        add_box(scene, {plate.side(), plate.side(), squeezer::thickness}, center, plate.mass).rotation =
            turn(Vec3::UnitZ(), plate.angle);
    }
    for (const squeezer::Hinge& hinge : squeezer::hinges()) {
        std::optional<std::size_t> first;
        if (hinge.first != squeezer::ground) first = std::size_t(hinge.first);
        add_joint(scene, JointType::hinge, first, std::size_t(hinge.second), at(hinge.at), Vec3::UnitZ());
    }
    // A couple of two forces, fixed in the crank.
    for (const double side : {-1.0, 1.0}) {
        ForceDescription force;
        force.body = 0;
        force.point = {0.0, -0.5 * side, 0.0};
        force.force = {squeezer::torque * side, 0.0, 0.0};
        force.body_frame = true;
        force.end = infinity;
        scene.forces.push_back(force);
    }
    const std::size_t body = squeezer::spring_plate;
    JointDescription& spring = add_joint(scene, JointType::distance, std::nullopt, body, at(squeezer::c));
    const BodyDescription& plate = scene.bodies[body];
    spring.anchor_second = plate.rotation.conjugate() * (at(squeezer::spring_end()) - plate.position);
    for (JointAxis& axis : spring.turn) axis.motion = JointAxis::Motion::free;
    for (JointAxis& axis : spring.move) axis.motion = JointAxis::Motion::free;
    spring.move[0].spring =
        JointSpring{.stiffness = squeezer::stiffness, .damping = 0.0, .rest = squeezer::rest_length};
    return scene;
}

struct Squeezed {
    double error = 0.0, gap = 0.0;  // rad: largest of the seven angles at the end; m
};

Squeezed squeeze(int steps, IntegratorKind integrator) {
    SceneDescription scene = squeezer_scene(steps);
    scene.simulation.integrator = integrator;
    World world(scene);
    Squeezed result;
    for (int i = 0; i < steps; ++i) {
        world.step();
        result.gap = std::max(result.gap, largest_gap(world));
    }
    const auto joints = world.joint_states();
    for (std::size_t k = 0; k < squeezer::ends.size(); ++k) {
        const double angle = squeezer::starts[k] + joints[k].position[3];
        result.error = std::max(result.error, std::abs(angle - squeezer::ends[k]));
    }
    return result;
}

TEST(JointReference, AndrewsSqueezer) {
    const Squeezed squeezed = squeeze(360, IntegratorKind::exact);
    EXPECT_LT(squeezed.error, 1e-11);
    EXPECT_LT(squeezed.gap, 1e-14);
}

TEST(JointReference, AndrewsSqueezerWithDefaultFlight) {
    const Squeezed coarse = squeeze(720, IntegratorKind::symplectic_euler);
    const Squeezed fine = squeeze(1440, IntegratorKind::symplectic_euler);  // 1/48,000 s
    EXPECT_LT(fine.error, 3e-4);
    EXPECT_NEAR(coarse.error / fine.error, 4.0, 0.1);
    EXPECT_LT(fine.gap, 1e-14);
}

}  // namespace
}  // namespace tumble::squeezer_test
