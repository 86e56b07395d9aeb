// Trajectories through the motions at both ends, against free rotation in closed form.
#include "sim/ccd/trajectory.h"

#include "sim/dynamics/body_builder.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tumble::trajectory_test {
namespace {

using namespace testing;

Body tumbling_box() {
    SceneDescription scene = empty_scene();
    BodyDescription& box = add_box(scene, {0.3, 0.5, 0.9}, {1.0, 2.0, 3.0});
    box.velocity = {0.5, -0.2, 0.1};
    box.angular_velocity = {3.0, -2.0, 4.0};
    return build_bodies(scene).front();
}

double angle(const Quat& a, const Quat& b) { return 2.0 * (a.conjugate() * b).vec().norm(); }

struct Errors {
    double place = 0.0, angle = 0.0, turning = 0.0;  // m, rad, rad/s
};

Errors errors_over(double span) {
    const Body body = tumbling_box();
    const Trajectory flight = Trajectory::flight(body, {0.0, -9.81, 0.0});
    const Trajectory path = Trajectory::between(body, flight.at(span), span);
    Errors worst;
    for (int k = 0; k <= 20; ++k) {
        const Motion is = path.at(0.05 * k * span), should = flight.at(0.05 * k * span);
        worst.place = std::max(worst.place, (is.position - should.position).norm());
        worst.angle = std::max(worst.angle, angle(is.orientation, should.orientation));
        worst.turning = std::max(worst.turning, (is.angular_velocity - should.angular_velocity).norm());
        EXPECT_LE(is.angular_velocity.norm(), path.spin_bound());
    }
    return worst;
}

TEST(Trajectory, BetweenTwoMotionsHasOrderFour) {
    const Errors coarse = errors_over(0.1), fine = errors_over(0.05);
    EXPECT_LT(coarse.place, 1e-14);
    EXPECT_LT(coarse.angle, 5e-5);
    EXPECT_NEAR(coarse.angle / fine.angle, 16.0, 2.0);
    EXPECT_NEAR(coarse.turning / fine.turning, 8.0, 1.0);
    EXPECT_LT(errors_over(1e-3).angle, 1e-12);
}

TEST(Trajectory, ItsBoundsHoldForTheAccelerationsOfPoints) {
    const Body body = tumbling_box();
    const Trajectory flight = Trajectory::flight(body, Vec3::Zero());
    for (const double span : {0.01, 0.1, 0.17}) {
        const Trajectory path = Trajectory::between(body, flight.at(span), span);
        double most = 0.0;
        for (int k = 1; k < 40; ++k) {
            const double t = 0.025 * k * span, d = 1e-4 * span;
            for (const Vec3& arm : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
                const auto at = [&](double s) { return Vec3(path.orientation(s) * arm); };
                most = std::max(most, (at(t + d) - 2.0 * at(t) + at(t - d)).norm() / (d * d));
            }
        }
        EXPECT_LE(most, path.turning_bound() * (1.0 + 1e-3)) << span;
        EXPECT_GE(most, 0.3 * path.turning_bound()) << span;
    }
}

// More than a radian: no longer one rotation vector.
TEST(Trajectory, LargeTurnsAreUniform) {
    const Body body = tumbling_box();
    const Motion end = Trajectory::flight(body, Vec3::Zero()).at(0.4);
    const Trajectory path = Trajectory::between(body, end, 0.4);
    EXPECT_LT(angle(path.orientation(0.4), end.orientation), 1e-13);
    EXPECT_EQ(path.at(0.1).angular_velocity, path.at(0.3).angular_velocity);
}

}  // namespace
}  // namespace tumble::trajectory_test
