// The documented limits of the simulation (docs/reference/guarantees-and-limits.md): each is there, and not larger.
#include "core/deterministic_math.h"
#include "scene/load.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace tumble::limits_test {
using namespace tumble::testing;
namespace {

constexpr double g = 9.81, mu = 0.4;

double deepest_overlap(const SceneDescription& scene, double seconds) {
    World world(scene);
    double deepest = 0.0;
    for (int frame = 0; frame < seconds * scene.output.fps; ++frame) {
        world.advance_frame();
        deepest = std::max(deepest, world.measure().max_penetration);
    }
    return deepest;
}

TEST(Limits, CubesOfAMillimeterUnderATonSinkIn) {
    SceneDescription scene = ground_scene(0.0, 0.5);
    for (const double x : {-0.4, 0.4})
        for (const double z : {-0.4, 0.4}) add_box(scene, Vec3::Constant(1e-3), {x, 5e-4, z}, 1e-6);
    add_box(scene, Vec3::Constant(1.0), {0.0, 0.501, 0.0}, 1000.0);
    for (BodyDescription& body : scene.bodies) body.friction = 0.5;
    World world(scene);
    run(world, scene, 1.0);
    const Snapshot end = world.snapshot();
    for (std::size_t cube = 1; cube <= 4; ++cube) EXPECT_LT(end.bodies[cube].origin.y(), 0.0) << cube;
    EXPECT_NEAR(end.bodies[5].origin.y(), 0.5, 1e-4);  // on the ground
}

// 60 balls of 1 cm that fall through 108 pegs at 5 m/s.
constexpr const char* balls_through_pegs = R"(
format = 1
[materials.glass]
friction = 0.3
restitution = 0.5
[[body]]
type = "fixed"
material = "glass"
shape = { type = "sphere", radius = 0.01 }
grid = { count = [6, 3, 6], spacing = 0.05 }
[[body]]
material = "glass"
shape = { type = "sphere", radius = 0.01 }
position = [0, 0.4, 0]
velocity = [0, -5, 0]
scatter = { count = 60, size = [0.25, 0.3, 0.25] }
)";

TEST(Limits, SmallFastBallsOverlapPegsForAMoment) {
    const auto overlap = [](int steps_per_frame, ImpactMode impacts) {  // of a radius
        SceneDescription scene = parse_scene(balls_through_pegs, "pegs.toml");
        scene.simulation.steps_per_frame = steps_per_frame;
        scene.simulation.impacts = impacts;
        return deepest_overlap(scene, 0.6) / 0.01;
    };
    EXPECT_LT(overlap(1, ImpactMode::stepped), 1.0);
    EXPECT_LT(overlap(16, ImpactMode::stepped), 0.25);
    EXPECT_LT(overlap(1, ImpactMode::exact), 0.05);
}

/// Distance that a plate of this length and width 1 m slides while it spins, under even pressure.
double sliding_distance(double length, double speed, double spin) {
    constexpr int along = 60, across = 16;
    constexpr double h = 1e-3;
    const double inertia = (length * length + 1.0) / 12.0;
    double x = 0.0, angle = 0.0, vx = speed, vz = 0.0, w = spin;
    while (std::hypot(vx, vz) > 1e-3 * speed) {
        const SinCos turn = sincos(angle);
        double fx = 0.0, fz = 0.0, torque = 0.0;
        for (int i = 0; i < along; ++i)
            for (int j = 0; j < across; ++j) {
                const double p = length * ((i + 0.5) / along - 0.5), q = (j + 0.5) / across - 0.5;
                const double rx = turn.cos * p + turn.sin * q, rz = turn.cos * q - turn.sin * p;
                const double ux = vx + w * rz, uz = vz - w * rx, u = std::hypot(ux, uz) + 1e-9;
                fx -= ux / u, fz -= uz / u, torque -= (ux * rz - uz * rx) / u;
            }
        const double impulse = mu * g * h / (along * across);
        vx += impulse * fx, vz += impulse * fz, w += impulse * torque / inertia;
        x += h * vx, angle += h * w;
    }
    return x;
}

TEST(Limits, ALongPlateWithAFastSpinSlidesTooFar) {
    for (const auto& [length, most] : {std::pair(1.0, 1.02), {4.0, 1.13}}) {
        SceneDescription scene = ground_scene(0.0, mu);
        BodyDescription& plate = add_box(scene, {length, 0.05, 1.0}, {0.0, 0.025, 0.0});
        plate.friction = mu;
        plate.velocity = {0.5, 0.0, 0.0};
        plate.angular_velocity = {0.0, 10.0, 0.0};
        World world(scene);
        run(world, scene, 5.0);
        const double ratio = world.snapshot().bodies[1].origin.x() / sliding_distance(length, 0.5, 10.0);
        EXPECT_LT(ratio, most) << length;
        EXPECT_GT(ratio, 0.98) << length;
    }
}

// A ring over a pole would fall around it; its hull has no hole.
TEST(Limits, AMovingMeshCollidesAsItsHull) {
    const MeshShape ring{load_mesh(std::filesystem::path(TUMBLE_SOURCE_DIR "/assets/meshes/torus.obj")).asset};
    const Bounds bounds = ring.asset->mesh.bounds();
    SceneDescription scene = ground_scene(0.0, 0.5);
    add_box(scene, {0.2, 2.0, 0.2}, {0.0, 1.0, 0.0}).type = BodyType::fixed;
    add_body(scene, ring, {0.0, 2.1 - bounds.min.y(), 0.0}).restitution = 0.0;
    World world(scene);
    run(world, scene, 1.0);
    EXPECT_NEAR(world.snapshot().bodies[2].origin.y(), 2.0 - bounds.min.y(), 1e-3);
}

}  // namespace
}  // namespace tumble::limits_test
