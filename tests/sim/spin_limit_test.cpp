// Turns that add nothing to the energy of a spin: the step's mean angular velocity against the closed form.
#include "sim/spin_limit.h"

#include "clusters.h"
#include "sim/free_rotation.h"
#include "sim/integrator.h"
#include "sim/tuning.h"
#include "sim/world.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

using namespace tumble;
using namespace tumble::testing;

namespace {

// Principal axes across the body's own, moments as far apart as 1 : 1.1 (a plate) and 1 : 400 (a needle).
Body spinning_body(Random& random, double turn, double h) {
    Body body = random_body(random, BodyType::dynamic, 1.0, 2.0);
    const double thin = std::pow(10.0, random(-2.6, -0.1));
    body.principal_inertia = body.mass * (random.below(2) ? Vec3(thin, 1.0, 1.0 - 0.5 * thin) : Vec3(1.0, 0.9 - 0.5 * thin, 0.6));
    body.principal_axes = random.turn();
    const Mat3 axes = body.principal_axes.toRotationMatrix();
    body.inertia_body = axes * body.principal_inertia.asDiagonal() * axes.transpose();
    body.inverse_inertia_body = axes * body.principal_inertia.cwiseInverse().asDiagonal() * axes.transpose();
    const Vec3 omega = turn / h * random.direction();
    body.angular_momentum = body.rotation * (body.inertia_body * (body.rotation.transpose() * omega));
    body.derive();
    return body;
}

double angle_between(const Quat& a, const Quat& b) { return 2.0 * (a.conjugate() * b).vec().norm(); }

}  // namespace

// A series up to tuning::spin_series_turn, with an error of the fourth order; the closed form beyond.
TEST(TurningVelocity, LeadsToWhereFreeRotationLeads) {
    Random random(301);
    constexpr double h = 1.0 / 60.0;
    for (const RotationForm form : {RotationForm::quaternion, RotationForm::matrix})
        for (const double turn : {0.001, 0.01, 0.09, 0.11, 0.3, 0.69})
            for (int trial = 0; trial < 100; ++trial) {
                Body body = spinning_body(random, turn, h);
                const FreeRotation rotation(body.principal_inertia, body.principal_axes, body.orientation, body.angular_momentum);
                const double before = spin(body);
                const Vec3 omega = turning_velocity(body, h, form, 0.0);
                advance_pose(body, Vec3::Zero(), omega, h, form);
                body.derive();
                const double error = turn < tuning::spin_series_turn ? std::pow(turn, 4) : 0.0;
                EXPECT_LT(angle_between(body.orientation, rotation.at(h)), error + 1e-13) << turn;
                EXPECT_NEAR(spin(body) / before, 1.0, error + 1e-10) << turn;
            }
}

// Omega itself where it adds too little, or the turn is too large; and the growth foretold is the growth that comes.
TEST(TurningVelocity, IsOmegaWhereThatAddsLittle) {
    Random random(302);
    constexpr double h = 1.0 / 60.0;
    for (int trial = 0; trial < 200; ++trial) {
        Body body = spinning_body(random, 0.02, h);
        Body turned = body;
        advance_pose(turned, Vec3::Zero(), body.angular_velocity, h, RotationForm::quaternion);
        turned.derive();
        const double growth = spin(turned) / spin(body) - 1.0;
        if (growth < 1e-6) continue;
        EXPECT_EQ(turning_velocity(body, h, RotationForm::quaternion, 1.5 * growth), body.angular_velocity);
        EXPECT_NE(turning_velocity(body, h, RotationForm::quaternion, growth / 1.5), body.angular_velocity);
        const Body fast = spinning_body(random, 1.1 * tuning::spin_largest_turn, h);
        EXPECT_EQ(turning_velocity(fast, h, RotationForm::quaternion, 0.0), fast.angular_velocity);
    }
}

// Two bricks that tumble at 12 rad/s past each other, near enough to be looked along: neither energy nor L changes.
TEST(TurningVelocity, BricksThatPassKeepTheirSpin) {
    SceneDescription scene = empty_scene(1);
    for (const double side : {-1.0, 1.0}) {
        BodyDescription& brick = add_box(scene, {1.0, 0.5, 0.2}, {15.0 * side, 0.7 * side, 0.0});
        brick.mass = 1.0;
        brick.velocity = {-20.0 * side, 0.0, 0.0};
        brick.angular_velocity = {1.0, 11.0, 4.0 * side};
    }
    World world(scene);
    const Measurement start = world.measure();
    for (int k = 0; k < 120; ++k) world.step();
    const Measurement now = world.measure();
    EXPECT_NEAR(now.kinetic / start.kinetic, 1.0, 1e-6);
    EXPECT_LT((now.angular_momentum - start.angular_momentum).norm(), 1e-11 * start.angular_momentum.norm());
}
