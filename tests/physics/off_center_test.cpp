// Hits that are not central, by steps: the bodies leave in the direction of the pose in which they met, wherever the
// end of the step lies, and the momenta, the angular momentum and the energy are kept.
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

// Frames show the way after the hit, whose record has its own time.
TEST(OffCenter, FramesAndRecordsFollowTheHit) {
    for (const int steps_per_frame : {1, 3, 16})
        for (const double phase : {0.07, 0.41, 0.83}) {
            const Hit hit{8.0, 1.3, phase, 0.6};
            SceneDescription scene = hit.scene();
            scene.simulation.steps_per_frame = steps_per_frame;
            scene.output.fps = 960.0 / steps_per_frame;
            World world(scene);
            world.record_contacts();
            const Vec3 v(hit.speed, 0.0, 0.0), n = hit.normal(), struck = 0.5 * (1.0 + hit.e) * v.dot(n) * n;
            const double met = (10.0 + phase) * step;
            int records = 0;
            while (world.snapshot().time < 0.03) {
                world.advance_frame();
                const Snapshot now = world.snapshot();
                const double since = std::max(0.0, now.time - met);
                EXPECT_LT((now.bodies[1].center_of_mass - since * struck).norm(), 1e-9) << phase << ' ' << now.time;
                const Vec3 other = scene.bodies[0].position + now.time * v - since * struck;
                EXPECT_LT((now.bodies[0].center_of_mass - other).norm(), 1e-9) << phase << ' ' << now.time;
                for (const ImpactRecord& impact : world.contact_records().impacts) {
                    ++records;
                    EXPECT_TRUE(impact.when.exact);
                    EXPECT_NEAR(impact.when.time, met, 1e-9);
                    EXPECT_EQ(impact.when.frame, now.frame - 1);
                }
            }
            EXPECT_EQ(records, 1) << phase;
        }
}

// A ball without friction that hits an edge of a block: v' = v - (1 + e) (v . n) n, with n from the edge to its center.
TEST(OffCenter, BallsLeaveAnEdgeAlongTheNormalOfTheMeeting) {
    for (const double speed : {1.0, 4.0, 12.0})
        for (const double phase : {0.07, 0.41, 0.83})
            for (const double beside : {0.1, 0.5, 0.9}) {  // of its center from the edge, in radii
                const double r = 0.05, e = 0.7;
                SceneDescription scene = empty_scene();
                add_box(scene, {1.0, 1.0, 1.0}, {-0.5, -0.5, 0.0}).type = BodyType::fixed;
                const Vec3 n(beside, std::sqrt(1.0 - beside * beside), 0.0), v(0.0, -speed, 0.0);
                BodyDescription& ball = add_sphere(scene, r, r * n - (10.0 + phase) * step * v);
                ball.velocity = v;
                ball.restitution = e;
                World world(scene);
                run(world, scene, 1.0 / 60.0);
                const Vec3 found = world.snapshot().bodies[1].velocity, expected = v - (1.0 + e) * v.dot(n) * n;
                EXPECT_LT(angle(found, expected), 0.01) << speed << ' ' << phase << ' ' << beside;
                EXPECT_NEAR(found.norm() / expected.norm(), 1.0, 1e-4) << speed << ' ' << phase << ' ' << beside;
            }
}

// A kinematic ball passes by a free one that floats.
TEST(OffCenter, AMovingSupportStrikesAlongTheNormalOfTheMeeting) {
    for (const double phase : {0.07, 0.41, 0.83}) {
        const Hit hit{6.0, 1.5, phase, 0.5};
        SceneDescription scene = hit.scene();
        BodyDescription& pusher = scene.bodies[0];
        pusher.type = BodyType::kinematic;
        pusher.interpolation = Interpolation::linear;
        for (const double t : {0.0, 1.0}) {
            Keyframe key;
            key.time = t;
            key.position = pusher.position + t * pusher.velocity;
            pusher.keyframes.push_back(key);
        }
        pusher.velocity.setZero();
        World world(scene);
        run(world, scene, 0.05);
        const Vec3 v(hit.speed, 0.0, 0.0), expected = (1.0 + hit.e) * v.dot(hit.normal()) * hit.normal();
        const Vec3 found = world.snapshot().bodies[1].velocity;
        EXPECT_LT(angle(found, expected), 0.01) << phase;
        EXPECT_NEAR(found.norm() / expected.norm(), 1.0, 1e-4) << phase;
    }
}

// Momentum, angular momentum about a point 10 m away, and energy of many hits.
TEST(OffCenter, ACrowdOfElasticBallsKeepsItsInvariants) {
    SceneDescription scene = empty_scene();
    for (int k = 0; k < 216; ++k) {
        const Vec3 place(double(k % 6), double(k / 6 % 6), double(k / 36));
        // Directions without a pattern, towards the middle.
        const Vec3 turn(std::sin(7.0 * k), std::sin(11.0 * k + 1.0), std::sin(13.0 * k + 2.0));
        const Vec3 aim = (Vec3(2.5, 2.5, 2.5) - place) + turn;
        add_ball(scene, Vec3(10.0, 3.0, -5.0) + 0.08 * place, 3.0 * aim.normalized(), 1.0);
    }
    World world(scene);
    const Measurement before = world.measure();
    run(world, scene, 0.4);
    const Measurement after = world.measure();
    EXPECT_GT((world.snapshot().bodies[0].velocity - scene.bodies[0].velocity).norm(), 0.1);
    EXPECT_NEAR(after.kinetic / before.kinetic, 1.0, 1e-12);
    EXPECT_LT((after.momentum - before.momentum).norm(), 1e-11);
    EXPECT_LT((after.angular_momentum - before.angular_momentum).norm(), 1e-9);
}

// A rack whose balls lie close together, in which one step has many hits, moves as in the event-driven mode.
TEST(OffCenter, ARackIsBrokenAsInTheEventDrivenMode) {
    SceneDescription scene = empty_scene();
    const double pitch = 2.0 * radius * 1.0005;
    add_ball(scene, {-0.3, 0.0, 0.004}, {8.0, 0.0, 0.0}, 0.95);
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k)
            add_ball(scene, {pitch * row * std::sqrt(0.75), 0.0, pitch * (k - 0.5 * row)}, Vec3::Zero(), 0.95);
    World stepped(scene);
    scene.simulation.impacts = ImpactMode::exact;
    World exact(scene);
    run(stepped, scene, 0.1);
    run(exact, scene, 0.1);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const BodyState found = stepped.snapshot().bodies[i], expected = exact.snapshot().bodies[i];
        EXPECT_LT((found.velocity - expected.velocity).norm(), 0.01) << i;
        EXPECT_LT((found.center_of_mass - expected.center_of_mass).norm(), 1e-3) << i;
    }
}

// A hit among balls that lie on a floor: the load of the floor is no obstacle.
TEST(OffCenter, BallsOnATableLeaveAlongTheLineOfTheirCenters) {
    const Hit hit{3.0, 1.6, 0.41, 0.9};
    SceneDescription scene = ground_scene(0.5, 0.0);
    for (const BodyDescription& ball : hit.scene().bodies) {
        scene.bodies.push_back(ball);
        scene.bodies.back().position.y() = radius;
        scene.bodies.back().friction = 0.0;
    }
    World world(scene);
    run(world, scene, 0.05);
    const Vec3 v(hit.speed, 0.0, 0.0), struck = 0.5 * (1.0 + hit.e) * v.dot(hit.normal()) * hit.normal();
    EXPECT_LT(angle(world.snapshot().bodies[2].velocity, struck), 0.01);
    EXPECT_LT(angle(world.snapshot().bodies[1].velocity, v - struck), 0.01);
}

// The mirror image of a scene moves as its mirror image.
TEST(OffCenter, AMirroredHitIsTheMirrorImage) {
    const auto after = [](double side) {
        SceneDescription scene = Hit{8.0, 1.8, 0.41, 0.8}.scene();
        for (BodyDescription& ball : scene.bodies) ball.position.z() *= side;
        World world(scene);
        run(world, scene, 0.05);
        return world.snapshot();
    };
    const Snapshot one = after(1.0), other = after(-1.0);
    for (std::size_t i = 0; i < 2; ++i) {
        Vec3 image = other.bodies[i].center_of_mass;
        image.z() = -image.z();
        EXPECT_LT((one.bodies[i].center_of_mass - image).norm(), 1e-14) << i;
    }
}

}  // namespace
}  // namespace tumble::off_center_test
