// Sleep seen from outside: it changes nothing visible, and ends exactly when it must.
#include "core/deterministic_math.h"
#include "sim/detection/broad_phase.h"
#include "sim/dynamics/body_builder.h"
#include "sim/random_shapes.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::contact_sleep_test {
using namespace tumble::testing;

namespace {

SceneDescription stack(int count, double friction = 0.5) {
    SceneDescription scene = ground_scene(0.0, friction, 4);
    for (int i = 0; i < count; ++i) add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5 + i, 0.0}).friction = friction;
    return scene;
}

bool moves(const World& world, std::size_t body) { return !world.snapshot().bodies[body].velocity.isZero(0.0); }
bool all_asleep(const World& world, std::size_t first, std::size_t last) {
    const Snapshot now = world.snapshot();
    for (std::size_t i = first; i <= last; ++i)
        if (!now.bodies[i].velocity.isZero(0.0) || !now.bodies[i].angular_velocity.isZero(0.0)) return false;
    return true;
}

void push(SceneDescription& scene, std::size_t body, const Vec3& force, double start, double end) {
    ForceDescription f;
    f.body = body;
    f.force = force;
    f.start = start;
    f.end = end;
    scene.forces.push_back(f);
}

}  // namespace

// A force begins at 2 s: in the step before all is still, in the step after the box moves by F/m.
TEST(Sleep, WakesInTheStepInWhichAForceBegins) {
    SceneDescription scene = stack(2, 0.0);
    push(scene, 2, Vec3(3.0, 0.0, 0.0), 2.0, 2.5);
    World world(scene);
    for (int k = 0; k < 480; ++k) world.step();  // h = 1/240: 2 s exactly
    EXPECT_TRUE(all_asleep(world, 1, 2));
    world.step();
    EXPECT_NEAR(world.snapshot().bodies[2].velocity.x(), 3.0 / 240.0, 1e-9);
    run(world, scene, 0.5 - 1.0 / 60.0);
    for (int k = 0; k < 3; ++k) world.step();
    EXPECT_NEAR(world.snapshot().bodies[2].velocity.x(), 1.5, 1e-6);  // the impulse of half a second
}

// The end of a force wakes the bodies that it supported: a box held against a slope's pull.
TEST(Sleep, WakesWhenAForceEnds) {
    const double angle = 0.3;
    SceneDescription scene = ground_scene(0.0, 0.0, 4);
    scene.bodies[0].shape = PlaneShape{Vec3(std::sin(angle), std::cos(angle), 0.0), 0.0};
    BodyDescription& box = add_box(scene, {1.0, 1.0, 1.0}, 0.5 * Vec3(std::sin(angle), std::cos(angle), 0.0));
    box.rotation = turn(Vec3::UnitZ(), -angle);
    push(scene, 1, -9.81 * std::sin(angle) * Vec3(std::cos(angle), -std::sin(angle), 0.0), 0.0, 2.0);
    World world(scene);
    run(world, scene, 2.0);
    EXPECT_TRUE(all_asleep(world, 1, 1));
    run(world, scene, 1.0);
    EXPECT_NEAR(world.snapshot().bodies[1].velocity.norm(), 9.81 * std::sin(angle), 0.01);
}

// A thousandth too steep, or not steep enough: a box slides off from rest by (sin - mu cos) g t^2 / 2, half a
// millimeter in the first second, or stays. It must not fall asleep while sliding.
TEST(Sleep, NotWhileSlidingOffSlowly) {
    const double tangent = 0.1, angle = arc_tangent(tangent);
    for (const double share : {0.999, 1.001}) {
        SceneDescription scene = ground_scene(0.0, share * tangent, 1);
        scene.simulation.gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0.0);
        add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0}).friction = share * tangent;
        World world(scene);
        run(world, scene, 4.0);
        const double way = share < 1.0 ? 0.5 * 9.81 * (1.0 - share) * std::sin(angle) * 16.0 : 0.0;
        EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.x(), way, 0.02 * way + 1e-7) << share;
        EXPECT_EQ(all_asleep(world, 1, 1), share > 1.0) << share;
    }
}

// The same from a hundredth of a meter to ten kilometers, much closer to the angle of friction, standing there or
// dropped, with every step and integrator: sleep changes no digit of a slide, and the displacement is that of
// mechanics.
TEST(Sleep, NotWhileSlidingOffAtAnyScale) {
    const double tangent = 0.1, angle = arc_tangent(tangent);
    for (const double size : {0.01, 1.0, 300.0, 1e4})
        for (const double acceleration : {1e-3, 3e-5, 1e-7})
            for (const int steps : {1, 16})
                for (const double drop : {0.0, 1e-4}) {
                    const double share = 1.0 - acceleration / (9.81 * std::sin(angle));
                    SceneDescription scene = ground_scene(0.0, share * tangent, steps);
                    scene.simulation.gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0.0);
                    scene.simulation.impacts = steps == 1 ? ImpactMode::stepped : ImpactMode::exact;
                    add_box(scene, Vec3::Constant(size), {0.0, (0.5 + drop) * size, 0.0}).friction = share * tangent;
                    Snapshot ends[2];
                    for (const bool sleep : {false, true}) {
                        scene.simulation.sleep = sleep;
                        World world(scene);
                        run(world, scene, 3.0);
                        ends[sleep] = world.snapshot();
                    }
                    EXPECT_EQ(ends[0].bodies[1].center_of_mass, ends[1].bodies[1].center_of_mass)
                        << size << " " << acceleration << " " << drop;
                    if (drop > 0.0 || steps == 1) continue;
                    EXPECT_NEAR(ends[1].bodies[1].center_of_mass.x(), 4.5 * acceleration,
                                0.01 * 4.5 * acceleration + 1e-8)
                        << size;
                }
}

// Balls on invisibly small slopes: one rolls off from rest, 5/7 g sin(angle), one is thrown up and comes back. A stack
// slides as one.
TEST(Sleep, NotWhileRollingOffOrTurningBack) {
    for (const double slope : {1e-5, 1e-8})
        for (const double back : {0.0, 1.3}) {
            SceneDescription scene = ground_scene(0.0, 0.5, 4);
            scene.simulation.gravity = Vec3(9.81 * slope, -9.81, 0.0);
            const double rate = 5.0 / 7.0 * 9.81 * slope;
            BodyDescription& ball = add_sphere(scene, 1.0, {0.0, 1.0, 0.0});
            ball.friction = 0.5;
            ball.velocity = Vec3(-back * rate, 0.0, 0.0);
            ball.angular_velocity = Vec3(0.0, 0.0, back * rate);
            World world(scene);
            run(world, scene, 4.0);
            const double way = 8.0 * rate - 4.0 * back * rate;
            EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.x(), way, 0.01 * 8.0 * rate) << slope << " " << back;
        }
    const double tangent = 0.1, angle = arc_tangent(tangent), acceleration = 1e-4;
    for (const double size : {1.0, 300.0}) {
        const double share = 1.0 - acceleration / (9.81 * std::sin(angle));
        SceneDescription scene = ground_scene(0.0, share * tangent, 4);
        scene.simulation.gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0.0);
        for (int i = 0; i < 5; ++i)
            add_box(scene, Vec3(2.0, 1.0, 2.0) * size, {0.0, size * (i + 0.5), 0.0}).friction =
                i ? 1.0 : share * tangent;
        World world(scene);
        run(world, scene, 4.0);
        EXPECT_NEAR(world.snapshot().bodies[5].center_of_mass.x(), 8.0 * acceleration, 0.01 * 8.0 * acceleration)
            << size;
    }
}

// An impact removes the lower box: the upper one, asleep on it, falls at once.
TEST(Sleep, FallsWhenItsSupportIsHitAway) {
    SceneDescription scene = stack(2, 0.0);
    scene.bodies[1].mass = 0.5;
    BodyDescription& ball = add_sphere(scene, 0.3, {-11.0, 0.5, 0.0}, 20.0);  // slides in along the floor, 10 m/s
    ball.velocity = Vec3(10.0 / 2.0, 0.0, 0.0);
    ball.position = Vec3(-10.8, 0.3, 0.0);
    World world(scene);
    run(world, scene, 1.5);
    EXPECT_TRUE(all_asleep(world, 1, 2));
    run(world, scene, 3.0);
    EXPECT_NEAR(world.snapshot().bodies[2].center_of_mass.y(), 0.5, 1e-3);
    EXPECT_GT(world.snapshot().bodies[1].center_of_mass.x(), 2.0);
}

// A shelf stands for two seconds and is then drawn away: bodies that slept on it fall freely.
TEST(Sleep, FallsWhenItsShelfMovesOff) {
    for (const bool down : {false, true}) {
        SceneDescription scene = ground_scene(0.0, 0.0, 4);
        BodyDescription& shelf = add_box(scene, {2.0, 0.2, 2.0}, {0.0, 4.0, 0.0});
        shelf.type = BodyType::kinematic;
        shelf.interpolation = Interpolation::linear;
        const Vec3 at(0.0, 4.0, 0.0), away = down ? Vec3(0.0, -40.0, 0.0) : Vec3(40.0, 4.0, 0.0);
        shelf.keyframes = {{0.0, at, Quat::Identity()}, {2.0, at, Quat::Identity()}, {2.4, away, Quat::Identity()}};
        add_box(scene, {1.0, 1.0, 1.0}, {0.0, 4.6, 0.0});
        World world(scene);
        run(world, scene, 2.0);
        EXPECT_TRUE(all_asleep(world, 2, 2)) << down;
        EXPECT_NEAR(world.snapshot().bodies[2].center_of_mass.y(), 4.6, 1e-6);
        run(world, scene, 0.5);
        // Down: free fall from 2 s on. Aside at 100 m/s: from the time when its middle is past the edge, 15 ms later.
        const double fall = 4.6 - 0.5 * 9.81 * 0.25;
        EXPECT_NEAR(world.snapshot().bodies[2].center_of_mass.y(), fall, down ? 0.02 : 0.1) << down;
    }
}

// A ball rolls by with a small gap: no body wakes. The next one touches.
TEST(Sleep, WakesWhenTouchedAndNotWhenPassed) {
    for (const double miss : {0.001, -0.001}) {
        SceneDescription scene = stack(1, 0.0);
        BodyDescription& ball = add_sphere(scene, 0.4, {-10.0, 0.4, 0.5 + 0.4 + miss});
        ball.velocity = Vec3(5.0, 0.0, 0.0);
        World world(scene);
        bool woke = false;
        for (int k = 0; k < 240 * 4; ++k) {
            world.step();
            if (k > 240) woke = woke || moves(world, 1);
        }
        EXPECT_EQ(woke, miss < 0.0) << miss;
    }
}

// Heaps fall to rest with and without sleep: until the first body sleeps both are the same to the last bit; then bodies
// stay within the tolerance of rest (sim/contact/model/settings.h), because all sleeping bodies have stopped moving.
TEST(Sleep, OnOrOffChangesNoPlaceByMoreThanATenthOfAMillimeter) {
    double most = 0.0;
    for (int trial = 0; trial < 4; ++trial) {
        Random random{std::uint64_t(trial)};
        SceneDescription scene = ground_scene(0.0, 0.6, 4);
        for (int i = 0; i < 12; ++i) {
            const Vec3 at((i % 3) * 1.1, 0.5 + 1.1 * (i / 6), (i / 3 % 2) * 1.1);
            add_box(scene, {1.0, 0.9, 0.8}, at).rotation = turn(random.direction(), 0.3);
        }
        for (BodyDescription& body : scene.bodies) body.friction = 0.6;
        Snapshot ends[2];
        for (const bool sleep : {false, true}) {
            scene.simulation.sleep = sleep;
            World world(scene);
            run(world, scene, 8.0);
            ends[sleep] = world.snapshot();
        }
        for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
            EXPECT_TRUE(ends[1].bodies[i].velocity.isZero(0.0)) << trial << " " << i;
            most = std::max(most, (ends[0].bodies[i].center_of_mass - ends[1].bodies[i].center_of_mass).norm());
        }
    }
    EXPECT_LE(most, 1e-4);
    RecordProperty("most", std::to_string(most));
}

// 10,000 boxes asleep on the floor and a ball that bounces beside and over them: its path is the one that it has alone,
// bit by bit, and no box wakes.
TEST(Sleep, SleepersDoNotDisturbABall) {
    std::vector<Vec3> path;
    for (const int side : {1, 100}) {
        SceneDescription scene = ground_scene(0.0, 0.0, 1);
        BodyDescription& ball = add_sphere(scene, 0.5, {-5.0, 2.0, 0.0});
        ball.restitution = 1.0;
        ball.velocity = Vec3(-0.3, 0.0, 0.2);
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i) add_box(scene, {1.0, 1.0, 1.0}, {1.5 * i, 0.5, 1.5 * j});
        World world(scene);
        run(world, scene, 1.0);
        EXPECT_TRUE(all_asleep(world, 2, scene.bodies.size() - 1));
        for (int frame = 0; frame < 60; ++frame) {
            world.advance_frame();
            const Vec3 at = world.snapshot().bodies[1].center_of_mass;
            if (side == 1)
                path.push_back(at);
            else
                ASSERT_EQ(at, path[std::size_t(frame)]) << frame;
        }
        EXPECT_TRUE(all_asleep(world, 2, scene.bodies.size() - 1));
    }
}

// Bodies visited: of 10,000 sleeping ones none is in the list of awake bodies, and no pair but those of the ball.
TEST(Sleep, SleepersAreNotVisited) {
    SceneDescription scene = ground_scene(0.0, 0.5, 1);
    add_sphere(scene, 0.5, {3.0, 1.6, 3.0});
    for (int i = 0; i < 10000; ++i) add_box(scene, {1.0, 1.0, 1.0}, {1.01 * (i % 100), 0.5, 1.01 * (i / 100)});
    std::vector<Body> bodies = build_bodies(scene);
    BroadPhase broad_phase;
    broad_phase.update(bodies, 1.0 / 60.0);
    EXPECT_EQ(broad_phase.awake().size(), 10001u);
    for (std::size_t i = 2; i < bodies.size(); ++i) bodies[i].asleep = true;
    for (int k = 0; k < 3; ++k) {
        bodies[1].position.x() += 0.5;
        const auto& pairs = broad_phase.update(bodies, 1.0 / 60.0);
        EXPECT_EQ(broad_phase.awake(), std::vector<std::uint32_t>{1});
        EXPECT_LE(pairs.size(), 20u);
        for (const auto& pair : pairs) EXPECT_TRUE(pair.a == 1 || pair.b == 1);
    }
}

}  // namespace tumble::contact_sleep_test
