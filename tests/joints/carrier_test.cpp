// Joined bodies on kinematic bodies, in joint coordinates: against equations of motion in the moving frame.
#include "sim/world.h"
#include "swept_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::carrier_test {
using namespace tumble::testing;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Ledger {
    double error = 0.0;   // rad
    double energy = 0.0;  // J, largest error of the balance
};

/// A pendulum of a small ball on an arm of 0.5 m hangs on a hoop's hub that turns about y at 6 rad/s:
/// a'' = w^2 sin a cos a - (g m l / I) sin a with the inertia of a ball, which turns with the hub too.
Ledger bead(IntegratorKind integrator, int steps, Interpolation interpolation) {
    constexpr double w = 6.0, l = 0.5, radius = 0.05, g = 9.81;
    SceneDescription scene = empty_scene();
    scene.simulation.gravity = {0.0, -g, 0.0};
    scene.simulation.integrator = integrator;
    scene.simulation.steps_per_frame = steps;
    scene.simulation.sleep = false;
    scene.output.fps = 60;
    BodyDescription& hub = add_box(scene, {0.1, 0.1, 0.1}, Vec3::Zero());
    hub.type = BodyType::kinematic;
    hub.interpolation = interpolation;
    for (int k = 0; k <= 40; ++k) {
        Keyframe key;
        key.time = 0.1 * k - 1.0;
        key.rotation = turn(Vec3::UnitY(), 0.1 * w * k - w);
        hub.keyframes.push_back(key);
    }
    const double start = 1.0;  // rad, from the vertical
    BodyDescription& ball = add_sphere(scene, radius, l * Vec3(std::sin(start), -std::cos(start), 0.0), 0.7);
    ball.rotation = turn(Vec3::UnitZ(), start);
    ball.angular_velocity = w * Vec3::UnitY();
    ball.velocity = ball.angular_velocity.cross(ball.position);
    add_joint(scene, JointType::hinge, 0, 1, Vec3::Zero(), Vec3::UnitZ());
    World world(scene);
    world.record_contacts();
    const double own = 0.4 * radius * radius;  // moment of inertia over the mass
    const auto rate = [&](double a) {
        return (w * w * l * l * std::sin(a) * std::cos(a) - g * l * std::sin(a)) / (l * l + own);
    };
    double a = start, v = 0.0;
    Ledger worst;
    const auto total = [&] {
        const Measurement m = world.measure();
        return m.kinetic + m.potential - world.contact_records().energy.work;
    };
    const double before = total();
    double sum = 0.0;
    for (int frame = 1; frame <= 60; ++frame) {
        world.advance_frame();
        constexpr int fine = 2000;
        const double h = 1.0 / 60.0 / fine;
        for (int k = 0; k < fine; ++k) {  // Runge and Kutta
            const double v1 = rate(a), v2 = rate(a + 0.5 * h * v), v3 = rate(a + 0.5 * h * (v + 0.5 * h * v1)),
                         v4 = rate(a + h * (v + 0.5 * h * v2));
            a += h * (v + h / 6.0 * (v1 + v2 + v3));
            v += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
        }
        const Vec3 place = world.snapshot().bodies[1].center_of_mass;
        worst.error = std::max(worst.error, std::abs(std::atan2(std::hypot(place.x(), place.z()), -place.y()) - a));
        sum = total();
        worst.energy = std::max(worst.energy, std::abs(sum - before));
    }
    return worst;
}

}  // namespace

TEST(JointCarriers, ABeadOnATurningHoop) {
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
        const Ledger exact = bead(IntegratorKind::exact, 4, interpolation);
        EXPECT_LT(exact.error, 1e-9);
        EXPECT_LT(exact.energy, 1e-9);
        const double coarse = bead(IntegratorKind::symplectic_euler, 4, interpolation).error,
                     fine = bead(IntegratorKind::symplectic_euler, 8, interpolation).error;
        EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2) << coarse << " " << fine;
        EXPECT_LT(fine, 1e-4);
    }
}

}  // namespace tumble::carrier_test
