// One body's step: rotations stay rotations, both forms agree, both Euler methods are their formulas.
#include "sim/dynamics/integrator.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

namespace tumble::integrator_test {
using namespace tumble::testing;

namespace {

double departure(const Mat3& r) { return (r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff(); }

}  // namespace

TEST(NearestRotation, OrthonormalAndIdempotent) {
    Random random(101);
    for (int trial = 0; trial < 1000; ++trial) {
        Mat3 m = random.turn().toRotationMatrix();
        const double off = trial % 4 == 0 ? 1e-15 : trial % 4 == 1 ? 1e-6 : trial % 4 == 2 ? 0.05 : 0.25;
        for (int i = 0; i < 3; ++i) m.col(i) += random.vector(off);
        const Mat3 r = nearest_rotation(m);
        EXPECT_LT(departure(r), 1e-14);
        EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
        EXPECT_LT((nearest_rotation(r) - r).cwiseAbs().maxCoeff(), 1e-15);
        // Nearest: R^T M of the polar factor is symmetric.
        const Mat3 s = r.transpose() * m;
        EXPECT_LT((s - s.transpose()).cwiseAbs().maxCoeff(), 1e-13);
    }
}

TEST(QuaternionOf, AgreesWithTheMatrix) {
    Random random(102);
    for (int trial = 0; trial < 2000; ++trial) {
        Quat q = random.turn();
        if (trial % 3 == 0) q = Quat(1e-9 * random(-1, 1), 1.0, 1e-9, random(-1, 1)).normalized();  // half turns
        const Mat3 m = q.toRotationMatrix();
        const Quat back = quaternion_of(m);
        EXPECT_NEAR(back.norm(), 1.0, 1e-15);
        EXPECT_LT((back.toRotationMatrix() - m).cwiseAbs().maxCoeff(), 1e-15 * 8);
        EXPECT_NEAR(std::abs(back.dot(q)), 1.0, 1e-15 * 4);
    }
}

// A rotation by h omega per step about a fixed axis: matrix form rotates by atan(h omega), quaternion form by
// 2 atan(h omega / 2).
TEST(AdvancePose, RotatesByItsStatedAngles) {
    Random random(103);
    for (int trial = 0; trial < 200; ++trial) {
        const double angle = trial % 2 ? random(0.0, 0.3) : random(0.0, 3.0);  // also absurdly fast spins
        const Vec3 axis = random.direction();
        for (const RotationForm form : {RotationForm::quaternion, RotationForm::matrix}) {
            Body body;
            body.orientation = random.turn();
            body.rotation = body.orientation.toRotationMatrix();
            const Mat3 before = body.rotation;
            advance_pose(body, Vec3(1, 2, 3), angle / 0.01 * axis, 0.01, form);
            const double turned = form == RotationForm::matrix ? std::atan(angle) : 2.0 * std::atan(0.5 * angle);
            const Mat3 expected = Eigen::AngleAxisd(turned, axis).toRotationMatrix() * before;
            EXPECT_LT((body.rotation - expected).cwiseAbs().maxCoeff(), 1e-13);
            EXPECT_LT((body.orientation.toRotationMatrix() - body.rotation).cwiseAbs().maxCoeff(), 1e-14);
            EXPECT_LT((body.position - 0.01 * Vec3(1, 2, 3)).norm(), 1e-16);
        }
    }
}

// A hundred thousand steps leave no drift from SO(3), and the two forms stay together as their angles do.
TEST(AdvancePose, StaysARotation) {
    for (const RotationForm form : {RotationForm::quaternion, RotationForm::matrix}) {
        Body body;
        Vec3 omega(1.0, 5.0, -2.0);
        for (int step = 0; step < 100000; ++step) {
            omega += 1e-3 * Vec3(omega.y(), -omega.z(), omega.x());
            if (omega.norm() > 50.0) omega *= 0.1;
            advance_pose(body, Vec3::Zero(), omega, 1e-3, form);
        }
        EXPECT_LT(departure(body.rotation), 1e-14);
        EXPECT_NEAR(body.orientation.norm(), 1.0, 1e-15);
        EXPECT_LT((body.orientation.toRotationMatrix() - body.rotation).cwiseAbs().maxCoeff(), 1e-14);
    }
}

TEST(AdvancePose, NoSpinChangesNoBit) {
    Random random(104);
    for (const RotationForm form : {RotationForm::quaternion, RotationForm::matrix}) {
        Body body;
        body.orientation = random.turn();
        body.rotation = body.orientation.toRotationMatrix();
        const Quat q = body.orientation;
        const Mat3 r = body.rotation;
        for (int i = 0; i < 100; ++i) advance_pose(body, Vec3(0.1, 0.0, 0.0), Vec3::Zero(), 0.01, form);
        EXPECT_EQ(body.orientation.coeffs(), q.coeffs());
        EXPECT_EQ(body.rotation, r);
    }
}

TEST(AdvanceMomenta, AreForceAndTorqueTimesStep) {
    Body body;
    body.momentum = Vec3(1, 2, 3);
    body.angular_momentum = Vec3(-1, 0, 1);
    advance_momenta(body, Vec3(10, 0, 0), Vec3(0, 20, 0), 0.25);
    EXPECT_EQ(body.momentum, Vec3(3.5, 2, 3));
    EXPECT_EQ(body.angular_momentum, Vec3(-1, 5, 1));
}

}  // namespace tumble::integrator_test
