// Bodies with faces of more corners than manifolds have room for: they come to rest on any of them.
#include "core/deterministic_math.h"
#include "sim/random_shapes.h"
#include "support/meshes.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace tumble::many_corners_test {
using namespace tumble::testing;

namespace {

constexpr double g = 9.81;

// Upright, its center at half its height.
std::shared_ptr<const MeshAsset> disc(int corners, double radius, double height) {
    TriangleMesh mesh;
    for (int k = 0; k < corners; ++k) {
        const auto [sine, cosine] = sincos(2.0 * pi * k / corners);
        for (const double y : {-0.5 * height, 0.5 * height})
            mesh.vertices.emplace_back(radius * cosine, y, radius * sine);
    }
    for (std::uint32_t k = 0; k < std::uint32_t(corners); ++k) {
        const std::uint32_t low = 2 * k, next = 2 * ((k + 1) % std::uint32_t(corners));
        mesh.triangles.push_back({low, low + 1, next + 1});
        mesh.triangles.push_back({low, next + 1, next});
        if (k == 0 || next == 0) continue;
        mesh.triangles.push_back({0, low, next});
        mesh.triangles.push_back({1, next + 1, low + 1});
    }
    return asset_of(mesh);
}

// On a plane, dropped a little, tilted by `tilt`; of mass 1 kg.
SceneDescription drop(std::shared_ptr<const MeshAsset> mesh, double radius, double tilt, double yaw, int steps) {
    SceneDescription scene = ground_scene(0.0, 0.5, steps);
    BodyDescription& body = add_body(scene, MeshShape{std::move(mesh)}, {0.1 * radius, (0.16 + tilt) * radius, 0.0});
    body.mass = 1.0;
    body.restitution = 0.0;
    body.friction = 0.5;
    body.rotation = turn({1.0, 0.0, 0.3}, tilt) * turn(Vec3::UnitY(), yaw);
    return scene;
}

// Within 12 s, on a force of its weight.
void expect_rest(const SceneDescription& scene, const std::string& what) {
    World world(scene);
    world.record_contacts();
    for (int half = 0; half < 24 && !world.snapshot().bodies[1].asleep; ++half) run(world, scene, 0.5);
    EXPECT_TRUE(world.snapshot().bodies[1].asleep) << what << ", " << world.measure().kinetic << " J";
    double force = 0.0;
    for (const ContactRecord& contact : world.contact_records().contacts) force += contact.normal_force;
    EXPECT_NEAR(force, g, 1e-4 * g) << what;
}

}  // namespace

TEST(ManyCorners, ATiltedDiscComesToRest) {
    for (const int steps : {1, 16})
        for (const int corners : {12, 16, 24})
            for (const double radius : {0.05, 5.0})
                for (const double yaw : {0.0, 0.4})
                    expect_rest(drop(disc(corners, radius, 0.3 * radius), radius, 0.02, yaw, steps),
                                std::to_string(corners) + " corners, radius " + std::to_string(radius));
}

// A face that is even to a share of the radius touches with three corners, and others are as far off.
TEST(ManyCorners, AnUnevenDiscComesToRest) {
    for (int seed = 0; seed < 20; ++seed) {
        Random random{std::uint64_t(seed)};
        const int corners = 10 + random.below(20), steps = 1 << (2 * random.below(3));
        const double radius = std::pow(10.0, random(-1.5, 1.0)), uneven = std::pow(10.0, random(-3.5, -1.5));
        TriangleMesh mesh = disc(corners, radius, 0.3 * radius)->mesh;
        for (std::size_t k = 0; k < mesh.vertices.size(); k += 2) {
            const double inside = random(0.8, 1.0);
            mesh.vertices[k] =
                mesh.vertices[k].cwiseProduct(Vec3(inside, 1.0, inside)) + radius * random(0.0, uneven) * Vec3::UnitY();
        }
        const double tilt = random(0.0, 0.1), yaw = random(0.0, 6.0);
        expect_rest(drop(asset_of(mesh), radius, tilt, yaw, steps), "seed " + std::to_string(seed));
    }
}

}  // namespace tumble::many_corners_test
