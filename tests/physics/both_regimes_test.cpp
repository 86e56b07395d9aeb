// Bodies at rest and in flight in one scene: resting bodies are stepped, ballistic ones move from impact to impact, and
// each may switch to the other.
#include "exact_scenes.h"
#include "sim/random_shapes.h"

#include <gtest/gtest.h>

namespace tumble::both_regimes_test {
using namespace tumble::testing;

namespace {

BodyDescription& add_platform(SceneDescription& scene, const Vec3& size, const std::vector<Keyframe>& keys,
                              double restitution) {
    BodyDescription& platform = add_fixed_box(scene, size, keys[0].position, restitution);
    platform.type = BodyType::kinematic;
    platform.keyframes = keys;
    platform.interpolation = Interpolation::linear;
    return platform;
}

}  // namespace

TEST(BothRegimes, BallBouncesOnAStandingStack) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    for (int i = 0; i < 3; ++i) add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5 + i, 0.0}, 10.0).friction = 0.5;
    BodyDescription& ball = add_sphere(scene, 0.1, {0.0, 4.1, 0.0}, 0.01);
    ball.restitution = 0.5;
    scene.simulation.sleep = false;
    make_exact(scene);
    World world(scene);
    double before = energy(world);
    for (int frame = 0; frame < 240; ++frame) {
        world.advance_frame();
        const double now = energy(world);
        ASSERT_LE(now, before + 1e-9 * 400.0) << frame;
        before = now;
    }
    const Snapshot s = world.snapshot();
    for (int i = 1; i <= 3; ++i)
        EXPECT_LE((s.bodies[std::size_t(i)].center_of_mass - Vec3(0.0, i - 0.5, 0.0)).norm(), 1e-4) << i;
    EXPECT_LE((s.bodies[4].center_of_mass - Vec3(0.0, 3.1, 0.0)).norm(), 1e-3);
    EXPECT_LE(world.measure().max_penetration, 1e-4);
}

// The slide's length v^2 / (2 mu g), within a step's displacement, beside a ball that bounces all the time.
TEST(BothRegimes, SlidingBoxBesideABouncingBall) {
    SceneDescription scene = ground_scene(0.0, 0.4);
    BodyDescription& box = add_box(scene, {1.0, 0.5, 1.0}, {0.0, 0.25, 0.0});
    box.friction = 0.4;
    box.velocity = Vec3(3.0, 0.0, 0.0);
    add_sphere(scene, 0.2, {0.0, 2.2, 5.0}).restitution = 1.0;
    make_exact(scene);
    World world(scene);
    for (int frame = 1; frame <= 180; ++frame) {
        world.advance_frame();
        ASSERT_NEAR(world.snapshot().bodies[2].center_of_mass.y() - 0.2, bouncing_clearance(2.0, 1.0, frame / 60.0),
                    1e-9)
            << frame;
    }
    EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.x(), 9.0 / (2.0 * 0.4 * gravity), 3.0 * scene.step());
    EXPECT_LE(world.snapshot().bodies[1].velocity.norm(), 1e-9);
}

// A platform that rises at 1 m/s: a ball released over it bounces as over a standing one, in the platform's frame;
// finally it rests and is carried.
TEST(BothRegimes, RisingPlatformCarriesABall) {
    for (const int steps : {1, 4, 16}) {
        SceneDescription scene = ground_scene(0.0, 0.0, steps);
        add_platform(scene, {4.0, 0.2, 4.0},
                     {{0.0, {0.0, 1.0, 0.0}, Quat::Identity()}, {20.0, {0.0, 21.0, 0.0}, Quat::Identity()}}, 0.5);
        BodyDescription& ball = add_sphere(scene, 0.1, {0.0, 2.2, 0.0});
        ball.restitution = 0.5;
        ball.velocity = Vec3(0.0, 1.0, 0.0);
        make_exact(scene);
        World world(scene);
        for (int frame = 1; frame <= 180; ++frame) {
            world.advance_frame();
            const double clearance = world.snapshot().bodies[2].center_of_mass.y() - 1.2 - frame / 60.0;
            ASSERT_NEAR(clearance, bouncing_clearance(1.0, 0.5, frame / 60.0), 1e-6) << steps << " " << frame;
        }
        EXPECT_NEAR(world.snapshot().bodies[2].velocity.y(), 1.0, 1e-6);
    }
}

// Hit by a platform at speed u, a ball at rest leaves at (1 + e) u, at the time of the touch.
TEST(BothRegimes, PlatformHitsABall) {
    for (const double u : {0.5, 5.0, 200.0})
        for (const double e : {0.0, 0.5, 1.0}) {
            SceneDescription scene = empty_scene(1);
            add_platform(
                scene, {0.2, 2.0, 2.0},
                {{0.0, {-1.0, 0.0, 0.0}, Quat::Identity()}, {10.0, {-1.0 + 10.0 * u, 0.0, 0.0}, Quat::Identity()}}, e);
            add_sphere(scene, 0.3, {0.0, 0.0, 0.0}).restitution = e;
            make_exact(scene);
            World world(scene);
            run(world, scene, 2.0);
            const double hit = 0.6 / u, x = world.snapshot().bodies[1].center_of_mass.x();
            EXPECT_NEAR(world.snapshot().bodies[1].velocity.x(), hit < 2.0 ? (1.0 + e) * u : 0.0, 1e-9 * u)
                << u << " " << e;
            EXPECT_NEAR(x, std::max(0.0, (2.0 - hit) * (1.0 + e) * u), 1e-6 * u) << u << " " << e;
        }
}

TEST(BothRegimes, BodiesInTheWindBounceAndLoseEnergy) {
    for (const int steps : {1, 16}) {
        SceneDescription scene = ground_scene(1.0, 0.0, steps);
        scene.wind = WindDescription{};
        for (int i = 0; i < 6; ++i) {
            BodyDescription& body = i % 2 ? add_sphere(scene, 0.2, {2.0 * i, 1.5, 0.0}, 0.1)
                                          : add_box(scene, {0.4, 0.3, 0.5}, {2.0 * i, 1.5, 0.0}, 0.1);
            body.restitution = 1.0;
            body.rotation = turn({1.0, double(i), 0.5}, 0.4 * i);
        }
        make_exact(scene);
        World world(scene);
        double before = energy(world);
        const double start = before;
        for (int frame = 0; frame < 180; ++frame) {
            world.advance_frame();
            const double now = energy(world);
            ASSERT_LE(now, before + 1e-9 * start) << steps << " " << frame;
            before = now;
            ASSERT_LE(world.measure().max_penetration, 1e-10) << steps << " " << frame;
        }
        EXPECT_LT(before, 0.9 * start);
        EXPECT_GT(before, 0.1 * start);
    }
}

// A force that starts in mid-clip, between frame times, on a body in flight and on one that has long been at rest.
TEST(BothRegimes, ForceAtAPointStartsInMidClip) {
    for (const int steps : {1, 16}) {
        SceneDescription scene = ground_scene(0.0, 0.0, steps);
        add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0}, 2.0);
        BodyDescription& flying = add_sphere(scene, 0.2, {5.0, 50.0, 0.0}, 2.0);
        flying.velocity = Vec3(0.0, 5.0, 0.0);
        for (const std::size_t body : {1, 2}) {
            ForceDescription push;
            push.body = body;
            push.force = Vec3(0.0, 0.0, 6.0);
            push.start = 1.5041;
            push.end = 1.8;
            scene.forces.push_back(push);
        }
        make_exact(scene);
        World world(scene);
        run(world, scene, 2.5);
        const double span = 1.8 - 1.5041, speed = 3.0 * span;
        const Snapshot s = world.snapshot();
        EXPECT_NEAR(s.bodies[2].velocity.z(), speed, 1e-9) << steps;
        EXPECT_NEAR(s.bodies[2].center_of_mass.z(), speed * (0.5 * span + 0.7), 1e-9) << steps;
        EXPECT_NEAR(s.bodies[2].center_of_mass.y(), 50.0 + 12.5 - 0.5 * gravity * 6.25, 1e-9) << steps;
        // Resting bodies are stepped: the start and end of the force are rounded to the step.
        EXPECT_NEAR(s.bodies[1].velocity.z(), speed, 3.0 * scene.step()) << steps;
        EXPECT_NEAR(s.bodies[1].center_of_mass.y(), 0.5, 1e-5) << steps;
    }
}

// An impact wakes boxes long asleep, and they share its momentum; those out of reach sleep on.
TEST(BothRegimes, ImpactWakesSleepers) {
    SceneDescription scene = ground_scene(0.0, 0.0);
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0}, 1.0);
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 8.0}, 1.0);
    BodyDescription& ball = add_sphere(scene, 0.25, {-60.0, 0.5, 0.0}, 1.0);
    ball.velocity = Vec3(10.0, 0.0, 0.0);
    scene.simulation.gravity = Vec3(0.0, -gravity, 0.0);
    // In the air until it meets the box 5.925 s later, at its own height.
    const double flight = (60.0 - 0.75) / 10.0;
    ball.velocity.y() = 0.5 * gravity * flight;
    make_exact(scene);
    World world(scene);
    run(world, scene, 5.5);
    const Vec3 asleep = world.snapshot().bodies[1].center_of_mass;
    run(world, scene, 0.4);
    EXPECT_EQ(world.snapshot().bodies[1].center_of_mass, asleep);
    for (int frame = 0; frame < 42; ++frame) {
        world.advance_frame();
        ASSERT_LE(world.measure().max_penetration, 1e-4) << frame;  // met, not found inside
    }
    const Snapshot s = world.snapshot();
    EXPECT_NEAR(s.bodies[1].velocity.x() + s.bodies[3].velocity.x(), 10.0, 1e-9);
    EXPECT_GT(s.bodies[1].velocity.x(), 1.0);
    EXPECT_EQ(s.bodies[2].velocity, Vec3(0.0, 0.0, 0.0));
}

// With all others asleep, nothing is stepped: a falling body meets them all the same, at any step.
TEST(BothRegimes, FallingBodiesLandOnSleepers) {
    for (const int steps : {1, 16})
        for (const double e : {0.0, 0.5}) {
            SceneDescription scene = ground_scene(0.0, 0.5, steps);
            add_box(scene, {0.5, 0.5, 0.5}, {0.0, 0.25, 0.0}).friction = 0.5;
            BodyDescription& ball = add_sphere(scene, 0.1, {0.05, 4.6, 0.0}, 0.1);
            ball.restitution = e;
            add_fixed_box(scene, {2.0, 0.2, 2.0}, {5.0, -0.1, 0.0}, 0.0);
            add_box(scene, {0.5, 0.5, 0.5}, {5.0, 0.25, 0.0}).friction = 0.5;
            // falls when all others have come to rest again
            add_box(scene, {0.2, 0.1, 0.2}, {5.0, 8.0, 0.1}, 0.1).restitution = e;
            make_exact(scene);
            World world(scene);
            for (int frame = 0; frame < 300; ++frame) {
                world.advance_frame();
                // In contact, and stepped, at one step per frame the small box may tumble a fifth of its thickness
                // deep.
                ASSERT_LE(world.measure().max_penetration, steps == 1 ? 2.5e-2 : 1e-4)
                    << steps << " " << e << " " << frame;
            }
            const Snapshot s = world.snapshot();
            EXPECT_NEAR(s.bodies[2].center_of_mass.y(), 0.6, 1e-4) << steps << " " << e;
            const double high = s.bodies[5].center_of_mass.y() - 0.5;  // flat, or on a side, because it tumbled
            EXPECT_NEAR(high, high < 0.075 ? 0.05 : 0.1, 1e-4) << steps << " " << e;
        }
}

// A heavy landing on a box does not press it into the ground in the rest of the step.
TEST(BothRegimes, LandingFindsTheSupportBelow) {
    for (const bool sleep : {true, false}) {
        SceneDescription scene = ground_scene(0.0, 0.5, 1);
        add_box(scene, {0.5, 0.5, 0.5}, {0.0, 0.25, 0.0}, 1.0);
        add_sphere(scene, 0.1, {0.0, 4.6, 0.0}, 10.0);
        scene.simulation.sleep = sleep;
        make_exact(scene);
        World world(scene);
        for (int frame = 0; frame < 90; ++frame) {
            world.advance_frame();
            ASSERT_LE(world.measure().max_penetration, 1e-5) << sleep << " " << frame;
        }
    }
}

// A ball lands on the end of a plank that lies on a block. Pressed between the two the plank is clamped step after
// step: it must not gain the work of gravity of the lost time.
TEST(BothRegimes, SeeSawGainsNothing) {
    for (const int steps : {1, 2, 4}) {
        SceneDescription scene;
        scene.simulation.steps_per_frame = steps;
        add_fixed_box(scene, {10.0, 1.0, 10.0}, {0.0, -0.5, 0.0}, 0.2);
        add_fixed_box(scene, {0.1, 0.03, 0.3}, {0.0, 0.015, 0.0}, 0.2);
        add_box(scene, {1.0, 0.02, 0.1}, {0.0, 0.04, 0.0}, 2.0).restitution = 0.2;
        add_sphere(scene, 0.1, {0.43, 0.65, 0.0}, 12.5).restitution = 0.2;
        for (BodyDescription& body : scene.bodies) body.friction = 0.0;
        make_exact(scene);
        World world(scene);
        const double start = energy(world);
        double before = start;
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            const double now = energy(world);
            ASSERT_LE(now, before + 1e-3 * start) << steps << " " << frame;
            before = now;
        }
    }
}

// A plank on a block, hit at its end, swings down to the floor within the step: it stops there. (A half-space pushes
// out any body below it.)
TEST(BothRegimes, StruckPlankStopsAtTheFloor) {
    for (const int steps : {1, 2, 4})
        for (const double speed : {3.0, 10.0}) {
            SceneDescription scene;
            scene.simulation.steps_per_frame = steps;
            add_fixed_box(scene, {10.0, 0.02, 10.0}, {0.0, -0.01, 0.0}, 0.0);
            add_fixed_box(scene, {0.1, 0.03, 0.3}, {0.0, 0.015, 0.0}, 0.0);
            add_box(scene, {1.0, 0.01, 0.1}, {0.0, 0.035, 0.0}, 1.0);
            add_sphere(scene, 0.1, {0.43, 3.14, 0.0}, 10.0).velocity = Vec3(0.0, -speed, 0.0);
            make_exact(scene);
            World world(scene);
            for (int frame = 0; frame < 60; ++frame) {
                world.advance_frame();
                ASSERT_LE(world.measure().max_penetration, 1e-3) << steps << " " << speed << " " << frame;
            }
        }
}

}  // namespace tumble::both_regimes_test
