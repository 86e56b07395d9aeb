#include "page/key_path.h"

#include <gtest/gtest.h>

#include "page/motion_segment.h"
#include "sim/math/free_rotation.h"

#include <vector>

namespace tumble::key_path_test {
namespace {

constexpr double fps = 60.0, g = 9.81;
constexpr std::size_t frames = 181;

/// A ball dropped from 1 m that keeps 0.8 of its speed at each bounce.
BodyRecord bouncing_ball() {
    BodyRecord ball;
    double start = 0.0, height = 1.0, speed = 0.0;  // of the present flight
    const auto y = [&](double t) { return height + speed * (t - start) - 0.5 * g * (t - start) * (t - start); };
    for (std::size_t n = 0; n < frames; ++n) {
        const double t = double(n) / fps;
        for (;;) {
            const double impact = start + (speed + std::sqrt(speed * speed + 2.0 * g * height)) / g;
            if (impact > t) break;
            const double down = speed - g * (impact - start);
            BodyEvent event{impact, {}, true};
            event.body.velocity_before.y() = down;
            event.body.velocity_after.y() = -0.8 * down;
            ball.events.push_back(event);
            start = impact;
            height = 0.0;
            speed = -0.8 * down;
        }
        BodySample sample;
        sample.position.y() = y(t);
        sample.velocity.y() = speed - g * (t - start);
        ball.samples.push_back(sample);
    }
    return ball;
}

TEST(KeyPath, ABouncingBallNeedsItsImpactsOnly) {
    const BodyRecord ball = bouncing_ball();
    ASSERT_GT(ball.events.size(), 4u);
    const KeyPath path = find_keys(ball, {fps, Mat3::Identity(), SIZE_MAX}).value();
    EXPECT_EQ(path.frames, (std::vector<std::size_t>{0, frames - 1}));
    EXPECT_LT(path.errors.position, 1e-13);
    EXPECT_LT(path.errors.velocity, 1e-11);
}

TEST(KeyPath, WithoutItsImpactsABallNeedsMoreFrames) {
    BodyRecord ball = bouncing_ball();
    const std::size_t impacts = ball.events.size();
    ball.events.clear();
    const KeyPath path = find_keys(ball, {fps, Mat3::Identity(), SIZE_MAX}).value();
    EXPECT_GE(path.frames.size(), 2 + 2 * impacts);
    EXPECT_LE(path.errors.position, page_key_tolerance.position);
}

TEST(KeyPath, OfMoreThanTheMostKeysThereIsNone) {
    BodyRecord ball = bouncing_ball();
    ball.events.clear();
    const std::size_t needed = find_keys(ball, {fps, Mat3::Identity(), SIZE_MAX}).value().frames.size();
    EXPECT_TRUE(find_keys(ball, {fps, Mat3::Identity(), needed}));
    EXPECT_FALSE(find_keys(ball, {fps, Mat3::Identity(), needed - 1}));
}

TEST(KeyPath, AFreeRotationHasFewKeysWithinTheTolerance) {
    const Vec3 principal{0.5, 1.0, 1.3}, momentum{0.3, 5.0, 0.1};
    const FreeRotation rotation(principal, Quat::Identity(), Quat::Identity(), momentum);
    BodyRecord body;
    for (std::size_t n = 0; n < frames; ++n) {
        BodySample sample;
        sample.rotation = rotation.at(double(n) / fps);
        sample.angular_velocity =
            sample.rotation * Vec3((sample.rotation.conjugate() * momentum).cwiseQuotient(principal));
        body.samples.push_back(sample);
    }
    const KeyPath path = find_keys(body, {fps, principal.asDiagonal(), SIZE_MAX}).value();
    EXPECT_LT(path.frames.size(), frames / 4);
    EXPECT_LE(path.errors.rotation, page_key_tolerance.rotation);
    EXPECT_LE(path.errors.angular_velocity, page_key_tolerance.angular_velocity);
}

}  // namespace
}  // namespace tumble::key_path_test
