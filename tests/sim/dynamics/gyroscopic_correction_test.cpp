// Rotations that add nothing to the energy of a spin: the step's mean angular velocity against the closed form.
#include "sim/dynamics/integrators/gyroscopic_correction.h"

#include "sim/clusters.h"
#include "sim/dynamics/integrator.h"
#include "sim/dynamics/settings.h"
#include "sim/math/free_rotation.h"
#include "sim/world.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::gyroscopic_correction_test {
using namespace tumble::testing;

namespace {

// Principal axes at an angle to the body's own, moments in ratios from 1 : 1.1 (a plate) to 1 : 400 (a needle).
void spin_at(Body& body, const Vec3& omega) {
    body.angular_momentum = body.rotation * (body.inertia_body * (body.rotation.transpose() * omega));
    body.derive();
}

Body spinning_body(Random& random, double turn, double h) {
    Body body = random_body(random, BodyType::dynamic, 1.0, 2.0);
    const double thin = std::pow(10.0, random(-2.6, -0.1));
    body.principal_inertia =
        body.mass * (random.below(2) ? Vec3(thin, 1.0, 1.0 - 0.5 * thin) : Vec3(1.0, 0.9 - 0.5 * thin, 0.6));
    body.principal_axes = random.turn();
    const Mat3 axes = body.principal_axes.toRotationMatrix();
    body.inertia_body = axes * body.principal_inertia.asDiagonal() * axes.transpose();
    body.inverse_inertia_body = axes * body.principal_inertia.cwiseInverse().asDiagonal() * axes.transpose();
    spin_at(body, turn / h * random.direction());
    return body;
}

double angle_between(const Quat& a, const Quat& b) { return 2.0 * (a.conjugate() * b).vec().norm(); }

}  // namespace

// A series up to tuning::spin_series_turn, with an error of the fourth order; the closed form beyond.
TEST(MeanAngularVelocity, EndsWithTheOrientationOfFreeRotation) {
    Random random(301);
    constexpr double h = 1.0 / 60.0;
    for (const RotationForm form : {RotationForm::quaternion, RotationForm::matrix})
        for (const double turn : {0.001, 0.01, 0.09, 0.11, 0.3, 0.69})
            for (int trial = 0; trial < 100; ++trial) {
                Body body = spinning_body(random, turn, h);
                const FreeRotation rotation(body.principal_inertia, body.principal_axes, body.orientation,
                                            body.angular_momentum);
                const double before = spin(body);
                const Vec3 omega = mean_angular_velocity(body, h, form);
                advance_pose(body, Vec3::Zero(), omega, h, form);
                body.derive();
                const double error = turn < tuning::spin_series_turn ? std::pow(turn, 4) : 0.0;
                EXPECT_LT(angle_between(body.orientation, rotation.at(h)), error + 1e-13) << turn;
                EXPECT_NEAR(spin(body) / before, 1.0, error + 1e-10) << turn;
            }
}

// Only the angle about a constant axis changes: omega is its own mean, and the step rotates by h omega, not by its
// arctangent.
TEST(MeanAngularVelocity, SteadySpinsRotateByTheirAngle) {
    Random random(303);
    constexpr double h = 1.0 / 60.0;
    for (const RotationForm form : {RotationForm::quaternion, RotationForm::matrix})
        for (const double turn : {0.001, 0.01, 0.09, 0.11, 0.3, 0.69})
            for (int axis = 0; axis < 4; ++axis) {
                Body body = spinning_body(random, turn, h);
                if (axis == 3) {
                    body.spherical_top = true;
                    body.principal_inertia.setConstant(0.4 * body.mass);
                    body.inertia_body = 0.4 * body.mass * Mat3::Identity();
                    body.inverse_inertia_body = 2.5 / body.mass * Mat3::Identity();
                }
                const Vec3 omega = turn / h *
                                   (axis == 3 ? random.direction()
                                              : Vec3((body.orientation * body.principal_axes) * Vec3::Unit(axis)));
                spin_at(body, omega);
                const Quat exact = Eigen::AngleAxisd(turn, omega.normalized()) * body.orientation;
                advance_pose(body, Vec3::Zero(), mean_angular_velocity(body, h, form), h, form);
                EXPECT_LT(angle_between(body.orientation, exact), 1e-10 * turn + 1e-13) << turn << ' ' << axis;
            }
}

// In contact a rotation by h omega where that adds a negligible energy, the mean elsewhere, one tangent where the
// rotation is too large; and the predicted growth equals the actual one.
TEST(MeanAngularVelocity, IsOmegaInContactWhereThatAddsNothing) {
    Random random(302);
    constexpr double h = 1.0 / 60.0;
    constexpr RotationForm form = RotationForm::quaternion;
    int little = 0, much = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const double turn = std::pow(10.0, random(-5.5, -2.5));
        Body body = spinning_body(random, turn, h);
        const Vec3& omega = body.angular_velocity;
        Body turned = body;
        turned.orientation = Eigen::AngleAxisd(h * omega.norm(), omega.normalized()) * body.orientation;
        turned.rotation = turned.orientation.toRotationMatrix();
        turned.derive();
        const double growth = spin(turned) / spin(body) - 1.0;
        if (growth < tuning::spin_steady / 1.5) {
            ++little;
            EXPECT_TRUE(gyration(body, h).isZero(0.0)) << growth;
            Body stepped = body;
            advance_pose(stepped, Vec3::Zero(), mean_angular_velocity_in_contact(body, h, form), h, form);
            EXPECT_LT(angle_between(stepped.orientation, turned.orientation), 1e-14);
        } else if (growth > 1.5 * tuning::spin_steady) {
            ++much;
            EXPECT_FALSE(gyration(body, h).isZero(0.0)) << growth;
            const Vec3 mean = mean_angular_velocity(body, h, form);
            EXPECT_LT((mean_angular_velocity_in_contact(body, h, form) - mean).norm(), 1e-14 * mean.norm());
        }
        const Body fast = spinning_body(random, 1.1 * tuning::spin_largest_turn, h);
        EXPECT_EQ(mean_angular_velocity_in_contact(fast, h, form), fast.angular_velocity);
    }
    EXPECT_GT(little, 100);
    EXPECT_GT(much, 100);
}

// Two bricks that tumble at 12 rad/s past each other, near enough for CCD: neither energy nor L changes.
TEST(MeanAngularVelocity, BricksThatPassKeepTheirSpin) {
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

}  // namespace tumble::gyroscopic_correction_test
