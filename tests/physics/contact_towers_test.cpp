// Stable structures stand: stacks, heavy on light, an arch, cards, hoops. All with default settings.
#include "core/deterministic_math.h"
#include "support/compounds.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

namespace tumble::contact_towers_test {
using namespace tumble::testing;

namespace {

SceneDescription floor_scene(double friction, int steps) {
    SceneDescription scene = ground_scene(0.0, friction, steps);
    scene.simulation.sleep = false;
    return scene;
}

void set_friction(SceneDescription& scene, double friction) {
    for (BodyDescription& body : scene.bodies) {
        body.friction = friction;
        body.restitution = 0.0;
    }
}

/// The largest distance of any body from its initial place.
double drift(const World& world, const SceneDescription& scene) {
    const Snapshot now = world.snapshot();
    double most = 0.0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].type == BodyType::dynamic)
            most = std::max(most, (now.bodies[i].origin - scene.bodies[i].position).norm());
    return most;
}

SceneDescription stack(int count, int steps) {
    SceneDescription scene = floor_scene(0.5, steps);
    for (int i = 0; i < count; ++i) add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5 + i, 0.0});
    set_friction(scene, 0.5);
    return scene;
}

/// A wedge of an arch: a trapezoid between chords of two circles, 1 m deep, its center of mass at the origin.
TriangleMesh stone(double inner_half, double outer_half, double low, double high) {
    TriangleMesh m = box_mesh({-1.0, -1.0, -0.5}, {1.0, 1.0, 0.5});
    for (Vec3& v : m.vertices) {
        const bool top = v.y() > 0.0;
        v = Vec3((v.x() > 0.0 ? 1.0 : -1.0) * (top ? outer_half : inner_half), top ? high : low, v.z());
    }
    return m;
}

}  // namespace

TEST(Towers, AStackOfTwentyStandsForAMinute) {
    const SceneDescription scene = stack(20, 1);
    World world(scene);
    run(world, scene, 60.0);
    EXPECT_LE(drift(world, scene), 1e-4);
    EXPECT_LE(world.measure().max_penetration, 2e-5);
}

TEST(Towers, AStackOfAHundredStands) {
    const SceneDescription scene = stack(100, 1);
    World world(scene);
    run(world, scene, 10.0);
    EXPECT_LE(drift(world, scene), 0.01);
    const Snapshot now = world.snapshot();
    for (std::size_t i = 1; i < now.bodies.size(); ++i)
        EXPECT_LE(std::hypot(now.bodies[i].center_of_mass.x(), now.bodies[i].center_of_mass.z()), 1e-3) << i;
}

TEST(Towers, HeavyOnLight) {
    for (const double mass : {1e3, 1e6})
        for (const int steps : {1, 16}) {
            SceneDescription scene = stack(2, steps);
            scene.bodies[2].mass = mass;
            World world(scene);
            for (int second = 0; second < 5; ++second) {
                run(world, scene, 1.0);
                EXPECT_LE(world.measure().max_penetration, 1e-5) << mass << " " << steps;
            }
            EXPECT_LE(drift(world, scene), 1e-5) << mass << " " << steps;
        }
}

// In the middle of a stack, and a light one on top of all.
TEST(Towers, HeavyBetweenLight) {
    SceneDescription scene = stack(5, 1);
    scene.bodies[3].mass = 1000.0;
    scene.bodies[5].mass = 0.01;
    World world(scene);
    run(world, scene, 10.0);
    EXPECT_LE(drift(world, scene), 1e-4);
    EXPECT_LE(world.measure().max_penetration, 1e-5);
}

TEST(Towers, AnArchOfFifteenStonesStands) {
    SceneDescription scene = floor_scene(0.7, 1);
    constexpr int stones = 15;
    const double half = 0.5 * pi / stones, inner = 4.0, outer = 5.0, spring = 1.0;
    const double low = inner * std::cos(half), high = outer * std::cos(half), a = inner * std::sin(half),
                 b = outer * std::sin(half);
    const double center = low + (high - low) * (a + 2.0 * b) / (3.0 * (a + b));
    const auto asset = asset_of(stone(a, b, low - center, high - center));
    for (int i = 0; i < stones; ++i) {
        const double angle = (2 * i + 1) * half - 0.5 * pi;  // from the vertical
        BodyDescription& body =
            add_body(scene, MeshShape{asset}, {center * std::sin(angle), spring + center * std::cos(angle), 0.0});
        body.rotation = turn(Vec3::UnitZ(), -angle);
        body.density = 2000.0;
    }
    for (const double side : {-1.0, 1.0})
        add_box(scene, {2.0, 1.0, 2.0}, {4.5 * side, 0.5, 0.0}).type = BodyType::fixed;
    set_friction(scene, 0.7);
    World world(scene);
    run(world, scene, 5.0);
    EXPECT_LE(drift(world, scene), 0.05);
}

TEST(Towers, AHouseOfCardsStands) {
    SceneDescription scene = floor_scene(0.6, 1);
    const double length = 0.9, width = 0.6, thick = 0.02, lean = 0.3, s = std::sin(lean), k = std::cos(lean),
                 mass = 10.8;
    const double up = 0.5 * (length * k + thick * s), aside = 0.5 * (thick * k + length * s), pitch = 0.8,
                 storey = 2.0 * up + thick;
    for (int level = 0; level < 3; ++level) {
        const int pairs = 3 - level;
        const double first = -0.5 * pitch * (pairs - 1), ground = storey * level;
        for (int i = 0; i < pairs; ++i)
            for (const double side : {-1.0, 1.0})
                add_box(scene, {thick, length, width}, {first + pitch * i + side * aside, ground + up, 0.0}, mass)
                    .rotation = turn(Vec3::UnitZ(), side * lean);
        for (int i = 0; i + 1 < pairs; ++i)
            add_box(scene, {pitch - 0.004, thick, width},
                    {first + pitch * (i + 0.5), ground + 2.0 * up + 0.5 * thick, 0.0}, mass * (pitch - 0.004) / length);
    }
    set_friction(scene, 0.6);
    World world(scene);
    run(world, scene, 5.0);
    EXPECT_LE(drift(world, scene), 0.02);
}

// Flat hoops of sixteen boxes each, one on the other, each rotated relative to the one below.
TEST(Towers, FiveHoopsStand) {
    SceneDescription scene = floor_scene(0.5, 1);
    constexpr int pieces = 16;
    const double radius = 1.0, thick = 0.1, half = pi / pieces;
    std::vector<CompoundPart> parts;
    for (int i = 0; i < pieces; ++i) {
        const Quat q = turn(Vec3::UnitY(), 2.0 * half * i);
        parts.push_back(
            part(BoxShape{Vec3(thick, thick, 2.0 * radius * std::tan(half))}, q * Vec3(radius, 0.0, 0.0), q));
    }
    const CompoundShape hoop = compound_of(parts);
    for (int i = 0; i < 5; ++i) {
        BodyDescription& body = add_body(scene, hoop, {0.0, (0.5 + i) * thick, 0.0});
        body.mass = 10.0;
        body.rotation = turn(Vec3::UnitY(), 0.7 * i);
    }
    set_friction(scene, 0.5);
    World world(scene);
    run(world, scene, 5.0);
    EXPECT_LE(drift(world, scene), 1e-3);
    EXPECT_LE(world.measure().max_penetration, 1e-3);
}

// SimBenchmark's rolling: a plate under 25 balls is dragged along; mu (M + 25 m) g slides under it, the balls roll.
TEST(Towers, BallsRollOnADraggedPlate) {
    for (const double angle : {0.0, 0.5, pi / 3.0}) {
        SceneDescription scene = ground_scene(0.0, 0.2, 1);
        scene.output.fps = 1000.0;
        const Vec3 along(std::cos(angle), 0.0, std::sin(angle));
        add_box(scene, {20.0, 1.0, 20.0}, {0.0, 0.5, 0.0}, 10.0).friction = 0.8;
        for (int i = 0; i < 25; ++i)
            add_sphere(scene, 0.5, {2.0 * (i % 5 - 2), 1.5, 2.0 * (i / 5 - 2)}, 1.0).friction = 0.8;
        ForceDescription force;
        force.body = 1;
        force.force = 150.0 * along;
        force.end = std::numeric_limits<double>::infinity();
        scene.forces.push_back(force);
        World world(scene);
        // The push on the plate beyond its floor's friction, shared with the balls' two sevenths.
        const double second = (150.0 - 0.4 * 35.0 * 9.81) / (3.5 * 10.0 + 25.0);
        double squared = 0.0;
        constexpr int steps = 1000;
        for (int k = 1; k <= steps; ++k) {
            world.step();
            const Snapshot now = world.snapshot();
            squared += (now.bodies[1].velocity - 3.5 * second * now.time * along).squaredNorm() +
                       (now.bodies[2].velocity - second * now.time * along).squaredNorm();
        }
        EXPECT_LE(squared / steps, 1e-12) << angle;
    }
}

}  // namespace tumble::contact_towers_test
