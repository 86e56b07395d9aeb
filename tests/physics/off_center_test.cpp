// Hits that are not central, by steps: the bodies leave in the direction of the pose in which they met, wherever the end of
// the step lies, and the momenta, the angular momentum and the energy are kept.
#include "scene/load.h"
#include "sim/world.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace tumble::off_center_test {
using namespace tumble::testing;

namespace {

constexpr double radius = 0.0286, step = 1.0 / 960.0;
constexpr double degrees = 180.0 / std::numbers::pi;

double angle(const Vec3& a, const Vec3& b) { return degrees * std::atan2(a.cross(b).norm(), a.dot(b)); }

BodyDescription& add_ball(SceneDescription& scene, const Vec3& position, const Vec3& velocity, double e) {
    BodyDescription& ball = add_sphere(scene, radius, position);
    ball.velocity = velocity;
    ball.restitution = e;
    return ball;
}

struct Hit {
    double speed = 8.0, offset = 1.8, phase = 0.0, e = 1.0;  // m/s; in radii; of a step
    // Unit vector from the first ball to the second as they touch.
    Vec3 normal() const {
        const double sine = 0.5 * offset;
        return {std::sqrt(1.0 - sine * sine), 0.0, -sine};
    }
    // Two balls; the first one comes along x. After the hit at t = 10 steps and a part.
    SceneDescription scene() const {
        SceneDescription scene = empty_scene();
        const double way = (10.0 + phase) * step * speed + 2.0 * radius * normal().x();
        add_ball(scene, {-way, 0.0, offset * radius}, {speed, 0.0, 0.0}, e);
        add_ball(scene, Vec3::Zero(), Vec3::Zero(), e);
        return scene;
    }
};

// The struck ball leaves along the line of centers, with the speed of eq. 20; the other one keeps the rest.
void expect_exact(const Hit& hit) {
    const SceneDescription scene = hit.scene();
    World world(scene);
    run(world, scene, 0.05);
    const Snapshot after = world.snapshot();
    const Vec3 v(hit.speed, 0.0, 0.0), n = hit.normal();
    const Vec3 struck = 0.5 * (1.0 + hit.e) * v.dot(n) * n, other = v - struck;
    const std::string which = std::to_string(hit.speed) + " m/s, offset " + std::to_string(hit.offset) + ", phase " +
                              std::to_string(hit.phase) + ", e " + std::to_string(hit.e);
    for (const auto& [body, expected] : {std::pair(1, struck), std::pair(0, other)}) {
        const Vec3 found = after.bodies[std::size_t(body)].velocity;
        EXPECT_LT(angle(found, expected), 0.01) << which;
        EXPECT_NEAR(found.norm() / expected.norm(), 1.0, 1e-4) << which;
        EXPECT_LT(after.bodies[std::size_t(body)].angular_velocity.norm(), 1e-9) << which;
    }
}

TEST(OffCenter, BallsLeaveAlongTheLineOfTheirCenters) {
    for (const double speed : {1.0, 3.0, 8.0, 20.0, 40.0})
        for (const double phase : {0.07, 0.41, 0.83})
            for (const double e : {0.0, 0.5, 1.0}) expect_exact({speed, 1.8, phase, e});
    for (const double offset : {0.3, 1.0, 1.5, 1.95}) expect_exact({8.0, offset, 0.41, 1.0});
}

}  // namespace
}  // namespace tumble::off_center_test
