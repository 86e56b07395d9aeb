#include "page/motion_segment.h"

#include <gtest/gtest.h>

#include "sim/math/free_rotation.h"

#include <cmath>

namespace tumble::motion_segment_test {
namespace {

const Vec3 gravity{0.0, -9.81, 0.0};
const Mat3 no_inertia = Mat3::Zero();

Moment thrown(double t) {
    const Vec3 velocity{2.0, 5.0, -1.0};
    Moment moment;
    moment.time = t;
    moment.position = Vec3(0.3, 1.0, 0.2) + t * velocity + 0.5 * t * t * gravity;
    moment.velocity = velocity + t * gravity;
    return moment;
}

TEST(MotionSegment, AParabolaIsExact) {
    const MotionSegment segment(thrown(0.1), thrown(1.7), no_inertia);
    for (double t = 0.1; t < 1.7; t += 0.0173) {
        EXPECT_LT((segment.at(t).position - thrown(t).position).norm(), 1e-14);
        EXPECT_LT((segment.at(t).velocity - thrown(t).velocity).norm(), 1e-13);
    }
}

TEST(MotionSegment, AUniformSpinOfManyTurnsIsExact) {
    const Vec3 spin{3.0, -12.0, 7.0};
    const auto turned = [&](double t) {
        Moment moment;
        moment.time = t;
        moment.rotation = turn_by(t * spin) * turn_by({0.3, 0.2, -0.5});
        moment.angular_velocity = spin;
        return moment;
    };
    const MotionSegment segment(turned(0.0), turned(2.0), no_inertia);
    for (double t = 0.0; t < 2.0; t += 0.0173) {
        EXPECT_LT(angle_between(segment.at(t).rotation, turned(t).rotation), 1e-13);
        EXPECT_LT((segment.at(t).angular_velocity - spin).norm(), 1e-12);
    }
}

/// A box that tumbles freely.
struct Tumbling {
    Vec3 principal{0.5, 1.0, 1.3};
    Vec3 momentum{1.0, 4.0, 0.5};
    FreeRotation rotation{principal, Quat::Identity(), turn_by({0.2, 0.7, 0.1}), momentum};

    Mat3 inertia() const { return principal.asDiagonal(); }
    Moment at(double t) const {
        Moment moment;
        moment.time = t;
        moment.rotation = rotation.at(t);
        moment.angular_velocity =
            moment.rotation * Vec3((moment.rotation.conjugate() * momentum).cwiseQuotient(principal));
        return moment;
    }
};

double largest_error(const Tumbling& body, double span) {
    const MotionSegment segment(body.at(0.0), body.at(span), body.inertia());
    double error = 0.0;
    for (int i = 1; i < 50; ++i) {
        const double t = span * i / 50.0;
        error = std::max(error, angle_between(segment.at(t).rotation, body.at(t).rotation));
    }
    return error;
}

TEST(MotionSegment, AFreeRotationIsOfSixthOrder) {
    const Tumbling body;
    const double coarse = largest_error(body, 0.2), fine = largest_error(body, 0.1);
    EXPECT_LT(coarse, 1e-5);
    EXPECT_NEAR(std::log2(coarse / fine), 6.0, 0.4);
}

TEST(MotionSegment, TheAngularVelocityIsTheDerivativeOfTheRotation) {
    const Tumbling body;
    const MotionSegment segment(body.at(0.0), body.at(0.3), body.inertia());
    for (const double t : {0.05, 0.14, 0.29}) {
        constexpr double h = 1e-5;
        const Vec3 turn = turn_of(segment.at(t + h).rotation * segment.at(t - h).rotation.conjugate());
        EXPECT_LT((turn / (2.0 * h) - segment.at(t).angular_velocity).norm(), 1e-6);
    }
}

TEST(MotionSegment, VelocitiesThatContradictTheWayAreNotFollowed) {
    Moment falling, resting;
    falling.position.y() = 0.02;
    falling.velocity.y() = -5.0;
    resting.time = 1.0 / 60.0;
    const MotionSegment landing(falling, resting, no_inertia);
    for (int i = 0; i <= 20; ++i) EXPECT_GE(landing.at(resting.time * i / 20.0).position.y(), -1e-15);
}

TEST(MotionSegment, ARotationVectorTurnsBack) {
    for (const double angle : {1e-12, 1e-3, 1.0, 3.1})
        EXPECT_LT((turn_of(turn_by(angle * Vec3(0.6, 0.0, 0.8))) - angle * Vec3(0.6, 0.0, 0.8)).norm(),
                  4e-16 + 1e-15 * angle);
}

}  // namespace
}  // namespace tumble::motion_segment_test
