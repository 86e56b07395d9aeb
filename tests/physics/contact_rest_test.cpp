// Rest and Coulomb's law to the last digit: no sinking, no drift, stick or slip according to the angle.
#include "core/deterministic_math.h"
#include "scene/load.h"
#include "sim/random_shapes.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace tumble::contact_rest_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

/// Ground that falls towards +x by an angle, and a body's place on it: `along` down the slope, `up` off it.
struct Slope {
    double angle;
    Vec3 normal() const { return {std::sin(angle), std::cos(angle), 0.0}; }
    Vec3 down() const { return {std::cos(angle), -std::sin(angle), 0.0}; }
    Vec3 at(double along, double up, double aside = 0.0) const {
        return along * down() + up * normal() + aside * Vec3::UnitZ();
    }
    Quat rotation() const { return turn(Vec3::UnitZ(), -angle); }
    SceneDescription scene(double friction, int steps) const {
        SceneDescription scene = ground_scene(0.0, friction, steps);
        scene.bodies[0].shape = PlaneShape{normal(), 0.0};
        scene.simulation.sleep = false;
        return scene;
    }
};

}  // namespace

// 600 s, awake: within a micrometer of its initial place, and there it stays. Coarse and fine steps, level and tilted.
TEST(ContactRest, ABoxRestsForTenMinutes) {
    for (const int steps : {1, 4})
        for (const double angle : {0.0, 0.3}) {
            const Slope slope{angle};
            SceneDescription scene = slope.scene(0.5, steps);
            BodyDescription& box = add_box(scene, {1.0, 1.0, 1.0}, slope.at(0.0, 0.5));
            box.friction = 0.5;
            box.rotation = slope.rotation();
            World world(scene);
            run(world, scene, 1.0);
            const Vec3 soon = world.snapshot().bodies[1].center_of_mass;
            EXPECT_LE((soon - box.position).norm(), 1e-6) << steps << " " << angle;
            const double overlap = world.measure().max_penetration;
            run(world, scene, 599.0);
            const Vec3 drift = world.snapshot().bodies[1].center_of_mass - soon;
            EXPECT_LE(drift.norm(), 1e-9) << steps << " " << angle;
            EXPECT_LE(overlap, 1e-6);
            EXPECT_LE(world.measure().max_penetration, 1e-6) << steps << " " << angle;
            EXPECT_LE(world.measure().kinetic, 1e-18);
        }
}

// More corners than manifolds have room for: a coin comes to rest after any fall, and lies on its face. Were its points
// to gather where it is deepest, it would rock without end, or lie in the ground.
TEST(ContactRest, ACoinLiesDown) {
    constexpr int corners = 64;
    TriangleMesh mesh;
    for (int k = 0; k < corners; ++k)
        for (const double y : {-0.01, 0.01})
            mesh.vertices.emplace_back(0.2 * std::cos(k * 2.0 * std::numbers::pi / corners), y,
                                       0.2 * std::sin(k * 2.0 * std::numbers::pi / corners));
    for (std::uint32_t k = 0; k < corners; ++k) {
        const std::uint32_t low = 2 * k, next = 2 * ((k + 1) % corners);
        mesh.triangles.push_back({low, low + 1, next + 1});
        mesh.triangles.push_back({low, next + 1, next});
        if (k == 0 || k + 1 == corners) continue;
        mesh.triangles.push_back({0, low, next});
        mesh.triangles.push_back({1, next + 1, low + 1});
    }
    const auto asset = asset_of(mesh);
    for (const int steps : {2, 16})
        for (const double tilt : {0.1, 0.4, 0.8, 1.2}) {
            SceneDescription scene = ground_scene(0.0, 0.6, steps);
            BodyDescription& coin = add_body(scene, MeshShape{asset}, {0.0, 0.35, 0.0});
            coin.restitution = 0.0;
            coin.friction = 0.6;
            coin.rotation = turn({1.0, 0.3, 0.2}, tilt);
            coin.angular_velocity = Vec3(1.0, -2.0, 3.0);
            World world(scene);
            run(world, scene, 10.0);
            EXPECT_EQ(world.measure().kinetic, 0.0) << steps << " " << tilt;
            EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.y(), 0.01, 1e-6) << steps << " " << tilt;
        }
}

// At one step per frame they move too far between steps for their points to be refreshed: at risk of lying up to 2 cm
// deep, rocking without end.
TEST(ContactRest, MeshesOfManyCornersLieDownAtOneStepPerFrame) {
    const struct {
        const char *file, *rotation;
    } cases[] = {{"bowl.obj", "[0.2142, 0.5094, 0.2049, -0.8079]"},
                 {"bowl.obj", "[0.0013, 0.3053, -0.2801, -0.9101]"},
                 {"torus.obj", "[0.3204, 0.5405, -0.7768, -0.042]"}};
    for (const auto& [file, rotation] : cases) {
        const SceneDescription scene = parse_scene(std::string(R"(
            format = 1
            [simulation]
            steps_per_frame = 1
            [[body]]
            type = "fixed"
            shape = { type = "plane" }
            friction = 0.6
            restitution = 0.0
            [[body]]
            shape = { type = "mesh", file = "../meshes/)") +
                                                       file + R"(" }
            position = [0.0, 2.5, 0.0]
            friction = 0.6
            restitution = 0.2
            rotation = )" + rotation + "\n",
                                                   TUMBLE_SOURCE_DIR "/assets/scenes/test.toml");
        World world(scene);
        run(world, scene, 12.0);
        EXPECT_EQ(world.measure().kinetic, 0.0) << file << rotation;
        EXPECT_LT(world.measure().max_penetration, 1e-4) << file << rotation;
    }
}

// On a mesh whose triangles are much smaller than the box, hundreds of them under it.
TEST(ContactRest, ABoxOnAFineMeshSticksOrSlips) {
    const double tangent = 0.1, angle = arc_tangent(tangent);
    for (const double share : {0.999, 1.001}) {
        SceneDescription scene = empty_scene(1);
        scene.simulation.sleep = false;
        scene.simulation.gravity = g * Vec3(std::sin(angle), -std::cos(angle), 0.0);
        BodyDescription& ground = add_body(scene, MeshShape{asset_of(grid_mesh(20, 2.0, 0.0))}, Vec3::Zero());
        ground.type = BodyType::fixed;
        ground.friction = share * tangent;
        BodyDescription& box = add_box(scene, {1.0, 0.5, 1.2}, {0.0, 0.25, 0.0});
        box.friction = share * tangent;
        box.rotation = turn(Vec3::UnitY(), 0.3);
        World world(scene);
        run(world, scene, 3.0);
        const double way = share < 1.0 ? 0.5 * g * (1.0 - share) * std::sin(angle) * 9.0 : 0.0;
        EXPECT_NEAR(world.snapshot().bodies[1].center_of_mass.x(), way, 0.02 * way + 1e-7) << share;
    }
}

// The finest step, for a minute; bodies of many shapes.
TEST(ContactRest, FineStepsChangeNothing) {
    SceneDescription scene = ground_scene(0.0, 0.5, 16);
    scene.simulation.sleep = false;
    add_box(scene, {1.0, 1.0, 1.0}, {0.0, 0.5, 0.0});
    add_box(scene, {3.0, 0.02, 0.5}, {4.0, 0.01, 0.0});
    add_box(scene, {0.1, 2.0, 0.1}, {-2.0, 1.0, 0.0});
    add_sphere(scene, 0.5, {0.0, 0.5, 3.0});
    for (BodyDescription& body : scene.bodies) body.friction = 0.5;
    World world(scene);
    run(world, scene, 60.0);
    const Snapshot end = world.snapshot();
    for (std::size_t i = 1; i < end.bodies.size(); ++i)
        EXPECT_LE((end.bodies[i].center_of_mass - scene.bodies[i].position).norm(), 1e-6) << i;
    EXPECT_LE(world.measure().max_penetration, 1e-6);
}

// Friction 0.1 % above tan(theta) holds without end; 0.1 % below it slides with g (sin - mu cos), a thousandth of g
// sin.
TEST(ContactRest, StickOrSlipToAThousandth) {
    for (const int steps : {1, 16})
        for (const double angle : {0.2, 0.5, 0.8})
            for (const double share : {0.999, 1.001}) {
                const Slope slope{angle};
                const double mu = share * std::tan(angle);
                SceneDescription scene = slope.scene(mu, steps);
                // Flat enough not to topple, and rotated about the normal: the disc is round.
                for (int k = 0; k < 4; ++k) {
                    BodyDescription& box = add_box(scene, {1.0, 0.2, 0.6}, slope.at(0.0, 0.1, 2.0 * k), 1.0 + k);
                    box.friction = mu;
                    box.rotation = slope.rotation() * turn(Vec3::UnitY(), 0.5 * k);
                }
                World world(scene);
                const double seconds = 3.0, n = std::round(seconds * 60.0 * steps);
                run(world, scene, seconds);
                // As in symplectic Euler: a t^2 (1 + 1/n) / 2.
                const double a = std::max(0.0, g * (std::sin(angle) - mu * std::cos(angle)));
                const double way = 0.5 * a * seconds * seconds * (1.0 + 1.0 / n);
                for (std::size_t k = 1; k <= 4; ++k) {
                    const Vec3 moved = world.snapshot().bodies[k].center_of_mass - scene.bodies[k].position;
                    EXPECT_NEAR(slope.down().dot(moved), way, share < 1.0 ? 0.01 * way : 1e-7)
                        << steps << " " << angle << " " << share << " " << k;
                    EXPECT_LE((moved - slope.down().dot(moved) * slope.down()).norm(), 1e-5)
                        << steps << " " << angle << " " << share << " " << k;
                }
            }
}

// Well below tan(theta): the acceleration to six digits.
TEST(ContactRest, TheAccelerationOfASlide) {
    for (const int steps : {1, 16})
        for (const double mu : {0.0, 0.1, 0.3}) {
            const Slope slope{0.5};
            SceneDescription scene = slope.scene(mu, steps);
            BodyDescription& box = add_box(scene, {1.0, 0.2, 0.6}, slope.at(0.0, 0.1));
            box.friction = mu;
            box.rotation = slope.rotation() * turn(Vec3::UnitY(), 0.7);
            World world(scene);
            run(world, scene, 2.0);
            const double a = g * (std::sin(0.5) - mu * std::cos(0.5));
            EXPECT_NEAR(world.snapshot().bodies[1].velocity.dot(slope.down()), 2.0 * a, 1e-6 * 2.0 * a)
                << steps << " " << mu;
        }
}

// Ten boxes leaning on a slope of 15 degrees in a pile: 4, 3, 2 and 1. Awake; twenty seconds.
TEST(ContactRest, APileOnASlopeDoesNotCreep) {
    for (const int steps : {1, 4}) {
        const Slope slope{15.0 * pi / 180.0};
        SceneDescription scene = slope.scene(0.8, steps);
        for (int row = 0; row < 4; ++row)
            for (int i = 0; i < 4 - row; ++i) {
                BodyDescription& box =
                    add_box(scene, {1.0, 1.0, 1.0}, slope.at(1.02 * (i + 0.5 * row), 0.5 + row), 1.0);
                box.rotation = slope.rotation();
            }
        for (BodyDescription& body : scene.bodies) body.friction = 0.8;
        World world(scene);
        run(world, scene, 1.0);
        const Snapshot soon = world.snapshot();
        run(world, scene, 20.0);
        double creep = 0.0;
        for (std::size_t i = 1; i < scene.bodies.size(); ++i)
            creep = std::max(creep, (world.snapshot().bodies[i].center_of_mass - soon.bodies[i].center_of_mass).norm());
        EXPECT_LE(creep, 1e-5) << steps;
        RecordProperty("creep", std::to_string(creep));
    }
}

// A row of single boxes and a stack of three on a slope, near the limit of friction.
TEST(ContactRest, AStackOnASlopeDoesNotCreep) {
    const Slope slope{15.0 * pi / 180.0};
    const double mu = 1.01 * std::tan(slope.angle);
    SceneDescription scene = slope.scene(mu, 4);
    for (int i = 0; i < 3; ++i)
        add_box(scene, {1.0, 0.5, 1.0}, slope.at(0.0, 0.25 + 0.5 * i)).rotation = slope.rotation();
    for (BodyDescription& body : scene.bodies) body.friction = mu;
    World world(scene);
    run(world, scene, 20.0);
    for (std::size_t i = 1; i <= 3; ++i)
        EXPECT_LE((world.snapshot().bodies[i].center_of_mass - scene.bodies[i].position).norm(), 1e-5) << i;
}

}  // namespace tumble::contact_rest_test
