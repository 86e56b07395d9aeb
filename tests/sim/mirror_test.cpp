// A mirrored scene moves as the mirror image: no side, axis or order of bodies is preferred. Mirrored at x = 0: positions and
// velocities change the sign of x; rotations and angular velocities, which are axial, those of y and z.
#include "random_scenes.h"

#include <gtest/gtest.h>

using namespace tumble;
using namespace tumble::testing;

namespace {

Vec3 mirror(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }
Vec3 mirror_axial(const Vec3& v) { return {v.x(), -v.y(), -v.z()}; }
Quat mirror(const Quat& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

std::shared_ptr<const MeshAsset> mirror(const MeshAsset& asset) {
    TriangleMesh mesh = asset.surface;
    for (Vec3& v : mesh.vertices) v = mirror(v);
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return asset_of(mesh);
}

SceneDescription mirror(SceneDescription scene) {
    for (BodyDescription& b : scene.bodies) {
        b.position = mirror(b.position);
        b.velocity = mirror(b.velocity);
        b.rotation = mirror(b.rotation);
        b.angular_velocity = mirror_axial(b.angular_velocity);
        if (auto* mesh = std::get_if<MeshShape>(&b.shape)) mesh->asset = mirror(*mesh->asset);
        if (auto* plane = std::get_if<PlaneShape>(&b.shape)) plane->normal = mirror(plane->normal);
    }
    return scene;
}

// Largest difference of the poses of the scene and of its mirror image, mirrored back, over the steps.
double asymmetry(const SceneDescription& scene, int steps) {
    World world(scene), image(mirror(scene));
    double most = 0.0;
    for (int step = 0; step < steps; ++step) {
        world.step();
        image.step();
        const Snapshot a = world.snapshot(), b = image.snapshot();
        for (std::size_t i = 0; i < a.bodies.size(); ++i) {
            most = std::max(most, (a.bodies[i].origin - mirror(b.bodies[i].origin)).norm());
            most = std::max(most, (a.bodies[i].orientation.coeffs() - mirror(b.bodies[i].orientation).coeffs()).norm());
        }
    }
    return most;
}

}  // namespace

// Flight, bounces at corners and edges, bodies that hit each other: to rounding while contacts come one at a time, which is
// nearly always.
TEST(Mirror, BouncingBodies) {
    Random random(131);
    int moved = 0, exact = 0;
    for (int trial = 0; trial < trials(20); ++trial) {
        SceneKind kind;
        kind.bodies = 9;
        kind.restitution_low = 0.3;
        kind.friction_high = 1.0;
        const SceneDescription scene = random_scene(random, kind);
        const double difference = asymmetry(scene, 250);
        EXPECT_LT(difference, 1e-6) << trial;
        exact += difference < 1e-12;
        World world(scene);
        run(world, scene, 0.25);
        for (std::size_t i = 1; i < scene.bodies.size(); ++i)
            moved += (world.snapshot().bodies[i].velocity - scene.bodies[i].velocity).cwiseProduct(Vec3(1, 0, 1)).norm() > 0.1;
    }
    EXPECT_GE(exact, trials(17) - 1);
    EXPECT_GT(moved, trials(60));   // sideways, so they did collide
}

// In islands of many contacts the order of the sweeps is not mirrored: equal as far as the solver converges.
TEST(Mirror, PilesWithoutFriction) {
    Random random(132);
    for (int trial = 0; trial < trials(20); ++trial) {
        SceneKind kind;
        kind.bodies = 6;
        kind.restitution_high = kind.friction_high = 0.0;
        EXPECT_LT(asymmetry(random_scene(random, kind), 250), 1e-5) << trial;
    }
}

// With friction what the sweeps find depends on their order too, but to no side.
TEST(Mirror, PilesWithFriction) {
    Random random(133);
    for (int trial = 0; trial < trials(20); ++trial) {
        SceneKind kind;
        kind.bodies = 6;
        kind.restitution_high = 0.0;
        EXPECT_LT(asymmetry(random_scene(random, kind), 250), 1e-2) << trial;
    }
}
