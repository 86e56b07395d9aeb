// Bodies with curved surfaces: rolling, rest, impacts, against closed forms.
#include "core/deterministic_math.h"
#include "sim/geometry/shapes/shape.h"
#include "support/curved.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace tumble::curved_bodies_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

Quat lying() { return turn(Vec3::UnitX(), 0.5 * pi); }  // the axis along z

/// The acceleration down a slope of 20 degrees, over a second of rolling from rest.
double rolling_acceleration(const CurvedShape& shape, double radius) {
    SceneDescription scene = ground_scene(0.0, 0.9);
    const SinCos slope = sincos(20.0 * pi / 180.0);
    scene.simulation.gravity = Vec3(g * slope.sin, -g * slope.cos, 0.0);
    BodyDescription& body = add_body(scene, shape, {0.0, radius, 0.0});
    body.rotation = lying();
    body.friction = 0.9;
    body.restitution = 0.0;
    World world(scene);
    run(world, scene, 1.0);
    return world.snapshot().bodies.back().velocity.x();
}

}  // namespace

// a = g sin 20 / (1 + I / m r^2).
TEST(CurvedBodies, RollDownASlope) {
    EXPECT_NEAR(rolling_acceleration(cylinder(0.5, 2.0), 0.5), 2.2368117373498735, 1e-6);
    EXPECT_NEAR(rolling_acceleration(capsule(0.5, 2.0), 0.5), 2.2747238006947866, 1e-6);
    EXPECT_NEAR(rolling_acceleration(ellipsoid(Vec3::Constant(0.5)), 0.5), 2.3965840043034359, 1e-6);
}

TEST(CurvedBodies, ACylinderRollsStraight) {
    SceneDescription scene = ground_scene(0.0, 0.9);
    BodyDescription& body = add_body(scene, cylinder(0.2, 0.5), {0.0, 0.2, 0.0});
    body.rotation = lying();
    body.friction = 0.9;
    body.restitution = 0.0;
    body.velocity = {2.0, 0.0, 0.0};
    body.angular_velocity = {0.0, 0.0, -10.0};
    World world(scene);
    run(world, scene, 5.0);
    const BodyState end = world.snapshot().bodies.back();
    EXPECT_NEAR(end.center_of_mass.x(), 10.0, 1e-6);
    EXPECT_LT(std::fabs(end.center_of_mass.z()), 1e-8);
    EXPECT_NEAR(end.center_of_mass.y(), 0.2, 1e-6);
    EXPECT_NEAR(end.velocity.x(), 2.0, 1e-6);
}

// Set down a little tilted and turned, on a plane and on a box.
TEST(CurvedBodies, StandingAndLyingBodiesComeToRest) {
    struct Case {
        const char* name;
        CurvedShape shape;
        double height;
        Quat rotation;
    };
    const Case cases[] = {{"can", cylinder(0.033, 0.12), 0.06, Quat::Identity()},
                          {"cone", cone(0.05, 0.1), 0.025, Quat::Identity()},
                          {"pill", capsule(0.01, 0.02), 0.01, lying()},
                          {"lying can", cylinder(0.033, 0.12), 0.033, lying()}};
    for (const Case& one : cases)
        for (const bool on_box : {false, true})
            for (const bool sleep : {true, false}) {
                SCOPED_TRACE(std::string(one.name) + (on_box ? " on a box" : " on a plane") + (sleep ? ", sleep" : ""));
                SceneDescription scene = ground_scene(0.0, 0.5);
                scene.simulation.sleep = sleep;
                if (on_box) {
                    scene.bodies[0].shape = BoxShape{{1.0, 0.1, 1.0}};
                    scene.bodies[0].position.y() = -0.05;
                }
                BodyDescription& body = add_body(scene, one.shape, {0.1, 0.0, 0.2});
                body.position.y() = one.height - mass_properties(one.shape, 1.0).center_of_mass.y();
                if (one.shape.kind == CurvedKind::cone) body.position.y() = 0.05;
                body.rotation = turn(Vec3::UnitY(), 0.3) * one.rotation;
                body.restitution = 0.0;
                World world(scene);
                run(world, scene, 1.0);
                if (sleep) {
                    EXPECT_TRUE(world.snapshot().bodies.back().asleep);
                    continue;
                }
                // Contact points are fixed in the body while it rests: they move with it.
                world.record_contacts();
                world.advance_frame();
                const auto points = [&] {
                    std::vector<Vec3> all;
                    for (const ContactRecord& c : world.contact_records().contacts) all.push_back(c.point);
                    return all;
                };
                const std::vector<Vec3> before = points();
                run(world, scene, 10.0);
                const std::vector<Vec3> after = points();
                ASSERT_EQ(before.size(), after.size());
                EXPECT_FALSE(before.empty());
                for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((after[i] - before[i]).norm(), 1e-6);
            }
}

// Internal edges of a mesh do not catch them; a can stands and rests on several triangles.
TEST(CurvedBodies, MeshesCarryThem) {
    SceneDescription scene = ground_scene(0.0, 0.9);
    scene.bodies[0].shape = MeshShape{asset_of(grid_mesh(20, 4.0, 0.0))};
    BodyDescription& wheel = add_body(scene, cylinder(0.2, 0.5), {-3.0, 0.2, 0.03});
    wheel.rotation = lying();
    wheel.velocity = {2.0, 0.0, 0.0};
    wheel.angular_velocity = {0.0, 0.0, -10.0};
    wheel.restitution = 0.0;
    wheel.friction = 0.9;
    BodyDescription& can = add_body(scene, cylinder(0.3, 0.5), {0.1, 0.251, 1.5});
    can.restitution = 0.0;
    World world(scene);
    run(world, scene, 2.0);
    const Snapshot end = world.snapshot();
    EXPECT_NEAR(end.bodies[1].center_of_mass.x(), 1.0, 1e-3);
    EXPECT_NEAR(end.bodies[1].center_of_mass.y(), 0.2, 1e-5);
    EXPECT_LT(std::fabs(end.bodies[1].center_of_mass.z() - 0.03), 1e-4);
    EXPECT_TRUE(end.bodies[2].asleep);
    EXPECT_NEAR(end.bodies[2].center_of_mass.y(), 0.25, 1e-5);
}

// A pencil of parts comes to rest on its side.
TEST(CurvedBodies, PartsOfCompoundsTouchTheGround) {
    SceneDescription scene = ground_scene(0.1, 0.5);
    auto parts = std::make_shared<std::vector<CompoundPart>>(2);
    (*parts)[0].shape = cylinder(0.004, 0.15);
    (*parts)[1].shape = cone(0.004, 0.014);
    (*parts)[1].position = {0.0, 0.082, 0.0};
    BodyDescription& pencil = add_body(scene, CompoundShape{parts}, {0.0, 0.05, 0.0});
    pencil.rotation = turn({0.2, 0.1, 1.0}, 1.2);
    pencil.friction = 0.5;
    pencil.restitution = 0.1;
    World world(scene);
    run(world, scene, 3.0);
    const BodyState end = world.snapshot().bodies[1];
    EXPECT_NEAR(end.center_of_mass.y(), 0.004, 1e-6);
    EXPECT_LT(std::fabs((end.orientation * Vec3::UnitY()).y()), 1e-4);
}

// A cylinder tips over its rim beyond atan(2 r / h), a cone beyond 45 degrees for r = h / 4.
TEST(CurvedBodies, TipOverTheirRims) {
    const auto tips = [](const CurvedShape& shape, double degrees) {
        SceneDescription scene = ground_scene(0.0, 0.9);
        const double angle = degrees * pi / 180.0, low = 0.5 * shape.height;
        BodyDescription& body = add_body(scene, shape, Vec3::Zero());
        body.rotation = turn(Vec3::UnitZ(), angle);
        body.position.y() = low * sincos(angle).cos + shape.radius * sincos(angle).sin + 1e-6;
        body.restitution = 0.0;
        body.friction = 0.9;
        World world(scene);
        run(world, scene, 2.0);
        const Quat& end = world.snapshot().bodies.back().orientation;
        return (end * Vec3::UnitY()).y() < 0.5;
    };
    EXPECT_FALSE(tips(cylinder(0.5, 2.0), 26.565 - 0.5));
    EXPECT_TRUE(tips(cylinder(0.5, 2.0), 26.565 + 0.5));
    EXPECT_FALSE(tips(cone(0.5, 2.0), 45.0 - 0.5));
    EXPECT_TRUE(tips(cone(0.5, 2.0), 45.0 + 0.5));
}

// Fast bodies against a thin wall: cylinder, cone and ellipsoid in flight, turning.
TEST(CurvedBodies, DoNotPassThroughThinWalls) {
    for (const char* mode : {"stepped", "exact"})
        for (const CurvedShape& shape :
             {cylinder(0.05, 0.2), cone(0.06, 0.2), ellipsoid({0.1, 0.05, 0.04}), capsule(0.04, 0.1)}) {
            SCOPED_TRACE(std::string(mode) + " " + std::to_string(int(shape.kind)));
            SceneDescription scene = empty_scene(4);
            if (std::string(mode) == "exact") scene.simulation.impacts = ImpactMode::exact;
            BodyDescription& wall = add_body(scene, BoxShape{{0.02, 4.0, 4.0}}, Vec3::Zero());
            wall.type = BodyType::fixed;
            wall.restitution = 0.5;
            BodyDescription& body = add_body(scene, shape, {-2.0, 0.1, 0.05});
            body.velocity = {40.0, 1.0, 0.0};
            body.angular_velocity = {3.0, -11.0, 17.0};
            body.restitution = 0.5;
            World world(scene);
            run(world, scene, 0.2);
            const BodyState end = world.snapshot().bodies.back();
            EXPECT_LT(end.center_of_mass.x(), -0.01);
            EXPECT_LT(end.velocity.x(), 0.0);
        }
}

// At 60 steps/s with the normals of the hit, as in exact mode; those of the overlap at the end of the step would give
// velocities that are off by 0.1 to 0.3 m/s.
TEST(CurvedBodies, HitsHaveTheirOwnTimesWithinAStep) {
    for (const CurvedShape& other : {cylinder(0.3, 0.8), ellipsoid({0.4, 0.3, 0.5})}) {
        SCOPED_TRACE(int(other.kind));
        const auto after = [&](ImpactMode mode) {
            SceneDescription scene = empty_scene(1);
            scene.simulation.gravity = Vec3::Zero();
            scene.simulation.impacts = mode;
            for (const double side : {-1.0, 1.0}) {
                BodyDescription& body =
                    add_body(scene, side < 0.0 ? capsule(0.25, 0.6) : other, {1.5 * side, 0.11 * side, 0.07 * side});
                body.rotation = turn({1.0, 2.0 * side, 0.5}, 0.7);
                body.velocity = {-4.0 * side, 0.0, 0.0};
                body.restitution = 1.0;
                body.friction = 0.0;
            }
            World world(scene);
            run(world, scene, 0.5);
            return world.snapshot().bodies[0];
        };
        const BodyState stepped = after(ImpactMode::stepped), exact = after(ImpactMode::exact);
        EXPECT_GT((exact.velocity - Vec3(4.0, 0.0, 0.0)).norm(), 2.0);
        EXPECT_LT((stepped.velocity - exact.velocity).norm(), 1e-3);
        EXPECT_LT((stepped.angular_velocity - exact.angular_velocity).norm(), 2e-3);
    }
}

// In exact mode an elastic cylinder keeps its energy through its bounces.
TEST(CurvedBodies, ExactBouncesKeepTheEnergy) {
    SceneDescription scene = ground_scene(1.0, 0.0);
    scene.simulation.impacts = ImpactMode::exact;
    BodyDescription& body = add_body(scene, cylinder(0.2, 0.5), {0.0, 1.0, 0.0});
    body.rotation = turn({1.0, 2.0, 0.5}, 0.7);
    body.angular_velocity = {2.0, 1.0, -3.0};
    body.restitution = 1.0;
    body.friction = 0.0;
    World world(scene);
    const double before = world.measure().kinetic + world.measure().potential;
    run(world, scene, 2.0);
    EXPECT_NEAR(world.measure().kinetic + world.measure().potential, before, 1e-9 * std::fabs(before));
}

}  // namespace tumble::curved_bodies_test
