// Bodies that slide or roll over a flush internal edge, or past an edge that they do not touch, continue undisturbed.
#include "core/deterministic_math.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::seam_test {
using namespace tumble::testing;

namespace {

// A row of fixed tiles of one meter along x, their tops at y = 0.
SceneDescription tiles(int steps_per_frame, int count = 9) {
    SceneDescription scene;
    scene.simulation.steps_per_frame = steps_per_frame;
    for (int i = -1; i < count - 1; ++i) {
        BodyDescription& tile = add_box(scene, {1.0, 0.5, 3.0}, {i + 0.5, -0.25, 0.0});
        tile.type = BodyType::fixed;
    }
    return scene;
}

}  // namespace

// Thin bodies move close to the next tile's side, whose separation equals that of its top: the side must not stop them.
TEST(Seam, DoesNotCatchThinPlates) {
    struct Case {
        Vec3 size;
        double speed;  // m/s
    };
    for (const Case& plate :
         {Case{{0.6, 0.02, 0.6}, 5.0}, Case{{0.2, 0.01, 0.3}, 3.0}, Case{{0.09, 0.0003, 0.06}, 2.0}})
        for (const double yaw : {0.0, 8.0, 45.0})
            for (const int steps : {1, 2, 4, 16}) {
                SceneDescription scene = tiles(steps);
                BodyDescription& body = add_box(scene, plate.size, {-0.5, 0.5 * plate.size.y(), 0.1});
                body.rotation = turn(Vec3::UnitY(), yaw * pi / 180.0);
                body.velocity = {plate.speed, 0.0, 0.3};
                World world(scene);
                run(world, scene, 1.0);
                const BodyState b = world.snapshot().bodies.back();
                EXPECT_LT((b.velocity - body.velocity).norm(), 1e-6) << plate.size.y() << ' ' << yaw << ' ' << steps;
                EXPECT_LT(b.angular_velocity.norm(), 1e-4) << plate.size.y() << ' ' << yaw << ' ' << steps;
            }
}

// A body that falls along a wall and grazes its edge is not held by the edge.
TEST(Seam, DoesNotCatchBodiesThatFallAlongAWall) {
    for (const int steps : {1, 4, 16}) {
        SceneDescription scene;
        scene.simulation.steps_per_frame = steps;
        for (const double y : {0.0, -1.0, -2.0, -3.0})
            add_box(scene, {1.0, 1.0, 1.0}, {-0.5, y, 0.0}).type = BodyType::fixed;
        add_box(scene, {0.02, 0.6, 0.6}, {0.01, 1.5, 0.0});
        World world(scene);
        run(world, scene, 0.75);
        const BodyState b = world.snapshot().bodies.back();
        // A step's fall is lost where it comes to the edge: at this speed it is clamped there (ccd_clamp.h).
        EXPECT_NEAR(b.velocity.y(), -9.81 * 0.75, 1.1 * 9.81 / (60.0 * steps)) << steps;
        EXPECT_NEAR(b.velocity.x(), 0.0, 1e-6) << steps;
        EXPECT_LT(b.angular_velocity.norm(), 1e-6) << steps;
    }
}

// The gap to the edge ahead closes ever more slowly: with a uniform closing speed the edge would throw balls up and
// slow them.
TEST(Seam, DoesNotCatchBalls) {
    for (const double speed : {0.7, 3.0, 5.0})
        for (const int steps : {1, 2, 4, 16}) {
            SceneDescription scene = tiles(steps);
            BodyDescription& ball = add_sphere(scene, 0.1, {-0.5, 0.1, 0.13});
            ball.velocity = {speed, 0.0, 0.3};
            World world(scene);
            double highest = 0.0;
            for (int frame = 0; frame < 60; ++frame) {
                run(world, scene, 1.0 / 60.0);
                highest = std::max(highest, world.snapshot().bodies.back().center_of_mass.y());
            }
            const BodyState b = world.snapshot().bodies.back();
            EXPECT_LT((b.velocity - ball.velocity).norm(), 1e-6) << speed << ' ' << steps;
            EXPECT_NEAR(highest, 0.1, 1e-8) << speed << ' ' << steps;
        }
}

// Balls that are parts of a compound do not catch either.
TEST(Seam, DoesNotCatchWheels) {
    SceneDescription scene = tiles(4);
    std::vector<CompoundPart> parts;
    for (const double z : {-0.2, 0.2}) {
        parts.emplace_back().shape = SphereShape{0.1};
        parts.back().position = {0.0, 0.0, z};
    }
    const CompoundShape axle{std::make_shared<std::vector<CompoundPart>>(parts)};
    for (BodyDescription& tile : scene.bodies) tile.friction = 0.9;
    BodyDescription& wheels = add_body(scene, axle, {-0.5, 0.1, 0.0});
    wheels.friction = 0.9;
    wheels.restitution = 0.0;
    wheels.velocity = {3.0, 0.0, 0.0};
    wheels.angular_velocity = {0.0, 0.0, -30.0};
    World world(scene);
    run(world, scene, 2.0);
    EXPECT_NEAR(world.snapshot().bodies.back().center_of_mass.x(), 5.5, 0.02);
    EXPECT_NEAR(world.snapshot().bodies.back().center_of_mass.y(), 0.1, 5e-5);
}

// A near miss is not a contact: balls that pass a ball, a box's edge or its corner at a tenth of a millimeter.
TEST(PredictedGap, ANearMissChangesNothing) {
    for (const int steps : {1, 2, 4, 16}) {
        SceneDescription scene = empty_scene(steps);
        const double gap = 1e-4, radius = 0.1, diagonal = std::sqrt(0.5) * (radius + gap);
        add_sphere(scene, radius, {0.0, 0.0, 0.0});
        add_sphere(scene, radius, {-1.0, 2.0 * radius + gap, 0.0});
        add_box(scene, {1.0, 1.0, 1.0}, {0.0, -3.0, 0.0}).type = BodyType::fixed;
        add_sphere(scene, radius, {-1.5, -2.5 + radius + gap, 0.0});         // over a face
        add_sphere(scene, radius, {-2.0, -2.5 + diagonal, 0.5 + diagonal});  // along an edge
        for (const std::size_t k : {1u, 3u, 4u}) scene.bodies[k].velocity = {6.0, 0.0, 0.0};
        BodyDescription& across =
            add_sphere(scene, radius, {0.5 + diagonal, -2.5 + diagonal + 1.0, 1.0});  // past an edge, askew
        across.velocity = {0.0, -6.0, -3.0};
        across.position.x() = 0.5 + radius + gap;
        World world(scene);
        run(world, scene, 0.5);
        for (const std::size_t k : {0u, 1u, 3u, 4u, 5u})
            EXPECT_LT((world.snapshot().bodies[k].velocity - scene.bodies[k].velocity).norm(), 1e-9)
                << k << ' ' << steps;
    }
}

}  // namespace tumble::seam_test
