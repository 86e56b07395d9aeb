// Resting contact: no sinking, no jitter, no gain of energy.
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::rest_test {
using namespace tumble::testing;

namespace {

double energy(const World& world) {
    const Measurement m = world.measure();
    return m.kinetic + m.potential;
}

SceneDescription stack(int count) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    for (int i = 0; i < count; ++i) add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5 + i, 0.0}).friction = 0.5;
    return scene;
}

}  // namespace

TEST(Rest, BoxOnTheFloorStaysForAMinuteToTheMicrometer) {
    SceneDescription scene = stack(1);
    scene.simulation.sleep = false;
    World world(scene);
    run(world, scene, 60.0);
    EXPECT_LT((world.snapshot().bodies[1].center_of_mass - Vec3(0.0, 0.5, 0.0)).norm(), 1e-6);
    EXPECT_LT(world.measure().kinetic, 1e-15);
    EXPECT_EQ(world.measure().contacts, 4);
}

TEST(Rest, StackOfTenStands) {
    SceneDescription scene = stack(10);
    scene.simulation.sleep = false;
    World world(scene);
    run(world, scene, 5.0);
    const Snapshot s = world.snapshot();
    for (int i = 1; i <= 10; ++i)
        EXPECT_LT((s.bodies[std::size_t(i)].center_of_mass - Vec3(0.0, i - 0.5, 0.0)).norm(), 1e-3);
    EXPECT_LT(world.measure().max_penetration, 1e-4);
}

TEST(Rest, HeavyOnLight) {
    SceneDescription scene = stack(2);
    scene.bodies[2].mass = 50.0;  // light under heavy converges slowly: see docs/reference/guarantees-and-limits.md
    World world(scene);
    run(world, scene, 3.0);
    EXPECT_LT(world.measure().max_penetration, 1e-5);
    EXPECT_NEAR(world.snapshot().bodies[2].center_of_mass.y(), 1.5, 1e-4);
}

// Boxes, spheres and hulls fall into a heap: energy never grows from frame to frame, nothing sinks, all comes to rest.
TEST(Rest, HeapLosesEnergyAndSettles) {
    SceneDescription scene = ground_scene(0.1, 0.6);
    for (int i = 0; i < 36; ++i) {
        const Vec3 at((i % 3) * 0.8 + 0.02 * (i % 7), 0.5 + 0.8 * (i / 9), ((i / 3) % 3) * 0.8 + 0.03 * (i % 5));
        BodyDescription& body = i % 3 == 0   ? add_sphere(scene, 0.3, at)
                                : i % 3 == 1 ? add_box(scene, {0.5, 0.6, 0.4}, at)
                                             : add_body(scene, MeshShape{icosahedron(0.35)}, at);
        body.mass = 1.0 + 0.2 * (i % 5);
        body.friction = 0.6;
        body.restitution = 0.1;
        body.rotation = turn({1.0, 0.1 * i, 0.5}, 0.3 * i);
    }
    World world(scene);
    double before = energy(world);
    const double scale = 36.0 * 9.81;  // J, about the energy of 36 bodies of 1 kg one meter high
    for (int frame = 0; frame < 480; ++frame) {
        world.advance_frame();
        const double now = energy(world);
        EXPECT_LT(now, before + 1e-4 * scale) << frame;
        before = now;
        EXPECT_LT(world.measure().max_penetration, 0.02) << frame;
    }
    EXPECT_LT(world.measure().max_penetration, 1e-3);
    const Snapshot s = world.snapshot();
    for (std::size_t i = 1; i < s.bodies.size(); ++i) {
        if (std::holds_alternative<SphereShape>(scene.bodies[i].shape))
            continue;  // no rolling friction: may still roll
        EXPECT_LT(s.bodies[i].velocity.norm(), 0.01) << i;
    }
}

// Asleep or awake: the same place, to within the drift that counts as rest.
TEST(Sleep, ChangesNoPositionBeyondItsTolerance) {
    Snapshot end[2];
    for (int k = 0; k < 2; ++k) {
        SceneDescription scene = stack(4);
        scene.simulation.sleep = k == 0;
        scene.bodies[4].position.x() = 0.2;
        World world(scene);
        run(world, scene, 4.0);
        end[k] = world.snapshot();
    }
    for (std::size_t i = 0; i < end[0].bodies.size(); ++i)
        EXPECT_LT((end[0].bodies[i].center_of_mass - end[1].bodies[i].center_of_mass).norm(), 2e-4);
}

TEST(Sleep, ASleepingStackWakesWhenHit) {
    SceneDescription scene = stack(3);
    BodyDescription& ball = add_sphere(scene, 0.3, {-20.0, 2.5, 0.0}, 5.0);
    ball.velocity = Vec3(10.0, 0.0, 0.0);
    ball.friction = 0.0;
    scene.simulation.gravity = Vec3(0.0, -9.81, 0.0);
    scene.bodies.back().position.y() = 2.5 + 0.5 * 9.81 * 3.6;  // arrives at the top box after 1.9 s
    World world(scene);
    run(world, scene, 1.5);
    EXPECT_TRUE(world.snapshot().bodies[3].velocity.isZero(0.0));  // asleep: exactly at rest
    run(world, scene, 1.5);
    EXPECT_GT((world.snapshot().bodies[3].center_of_mass - Vec3(0.0, 2.5, 0.0)).norm(), 0.1);
}

// A slowly drifting free body is not at rest.
TEST(Sleep, NeverInFreeFlight) {
    SceneDescription scene = empty_scene(4);
    add_box(scene, {1.0, 1.0, 1.0}, Vec3::Zero()).velocity = Vec3(1e-5, 0.0, 0.0);
    World world(scene);
    run(world, scene, 10.0);
    EXPECT_NEAR(world.snapshot().bodies[0].center_of_mass.x(), 1e-4, 1e-12);
}

// Internal edges of a tessellated floor must not catch a sliding box or ball.
TEST(MeshShape, InternalEdgesDoNotCatch) {
    for (const bool sphere : {false, true}) {
        SceneDescription scene;
        BodyDescription& floor = add_body(scene, MeshShape{asset_of(grid_mesh(20, 5.0, 0.0))}, Vec3::Zero());
        floor.type = BodyType::fixed;
        floor.restitution = 0.0;
        BodyDescription& body =
            sphere ? add_sphere(scene, 0.3, {-4.0, 0.3, 0.13}) : add_box(scene, {0.6, 0.6, 0.6}, {-4.0, 0.3, 0.13});
        body.velocity = Vec3(2.0, 0.0, 0.3);
        World world(scene);
        run(world, scene, 3.0);
        const BodyState b = world.snapshot().bodies[1];
        EXPECT_LT((b.velocity - Vec3(2.0, 0.0, 0.3)).norm(), 1e-6) << sphere;
        EXPECT_NEAR(b.center_of_mass.y(), 0.3, 1e-5);
    }
}

// A closed mesh holds bodies on its outside, an open one on either side.
TEST(MeshShape, HoldsFallingBodies) {
    for (const bool closed : {true, false}) {
        SceneDescription scene;
        BodyDescription& table = add_body(
            scene, MeshShape{asset_of(closed ? box_mesh({-2.0, -0.5, -2.0}, {2.0, 0.0, 2.0}) : grid_mesh(3, 2.0, 0.0))},
            Vec3::Zero());
        table.type = BodyType::fixed;
        table.friction = 0.5;
        add_box(scene, {0.5, 0.5, 0.5}, {0.3, 1.0, 0.2}).rotation = turn({1.0, 0.5, 0.2}, 0.6);
        add_sphere(scene, 0.3, {-1.0, 1.0, -1.0});
        BodyDescription& gem = add_body(scene, MeshShape{icosahedron(0.4)}, {1.0, 0.4, 1.0});
        gem.restitution = 0.0;
        gem.rotation = turn({1.0, 0.0, 0.3}, 0.2);  // without tilt it would balance on an edge
        for (BodyDescription& b : scene.bodies) b.friction = 0.5;
        World world(scene);
        run(world, scene, 3.0);
        const Snapshot s = world.snapshot();
        EXPECT_NEAR(s.bodies[1].center_of_mass.y(), 0.25, 1e-3) << closed;
        EXPECT_NEAR(s.bodies[2].center_of_mass.y(), 0.3, 1e-3) << closed;
        EXPECT_NEAR(s.bodies[3].center_of_mass.y(), 0.4 * 0.7946544723, 1e-3) << closed;  // inradius of the icosahedron
    }
}

}  // namespace tumble::rest_test
