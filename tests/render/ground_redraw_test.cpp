// On large receivers made of boxes, meshes and balls, partial redraw gives the bytes of a full redraw, and draws less.
#include "drawing.h"
#include "example_scenes.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tumble::ground_redraw_test {
namespace {

constexpr Color stone{176, 180, 184};

BodyDescription slab(const Vec3& top, const Vec3& size, const Quat& rotation = Quat::Identity()) {
    BodyDescription body = box_body(top - rotation * Vec3(0.0, 0.5 * size.y(), 0.0), size, stone, rotation);
    body.type = BodyType::fixed;
    return body;
}

Quat turned_about(const Vec3& axis, double radians) { return Quat(Eigen::AngleAxisd(radians, axis)); }

// A height field over a square grid with `cells` per side; normals of the adjacent triangles.
template <class Height>
std::shared_ptr<const MeshAsset> hills(double size, std::uint32_t cells, Height height) {
    auto asset = std::make_shared<MeshAsset>(*sheet_asset(size, cells));
    for (std::size_t i = 0; i < asset->vertices.size(); ++i) {
        Vec3& p = asset->mesh.vertices[i];
        p.y() = height(p.x(), p.z());
        const double e = 1e-3 * size;
        const Vec3 normal = Vec3(height(p.x() - e, p.z()) - height(p.x() + e, p.z()), 2.0 * e,
                                 height(p.x(), p.z() - e) - height(p.x(), p.z() + e))
                                .normalized();
        for (int k = 0; k < 3; ++k) {
            asset->vertices[i].position[k] = float(p[k]);
            asset->vertices[i].normal[k] = float(normal[k]);
        }
    }
    return asset;
}

// Hills, a bowl with steep sides, an oblique sheet of few triangles, a ring around the bodies, or a ball below them.
void add_curved_ground(SceneDescription& scene, Random& random, unsigned kind) {
    const double size = std::pow(10.0, random.between(0.7, 2.0)), high = random.between(0.1, 0.8);
    const auto cells = std::uint32_t(random.between(4.0, 40.0));
    BodyDescription body = ball_body(Vec3(0.0, -size, 0.0), size, stone);
    const auto waves = [&](double x, double z) { return high * (std::sin(x) * std::cos(0.8 * z) - 0.5); };
    const auto hollow = [&](double x, double z) { return high * (x * x + z * z) / size; };
    const Quat slant = turned_about(Vec3::UnitX(), random.between(-0.4, 0.4));
    if (kind == 0) body = mesh_body(Vec3::Zero(), hills(size, cells, waves), stone);
    if (kind == 1) body = mesh_body(Vec3(0.0, -0.5, 0.0), hills(size, cells, hollow), stone);
    if (kind == 2) body = mesh_body(Vec3::Zero(), sheet_asset(size, std::max(cells / 8, 1u)), stone, slant);
    if (kind == 3) body = mesh_body(Vec3(0.0, -0.6, 0.0), torus_asset(0.3 * size, 0.1 * size), stone);
    body.type = BodyType::fixed;
    if (random.chance(0.3)) body.appearance.pattern = Pattern::grid;
    scene.bodies.push_back(body);
}

// A floor, a ramp, a room, or two floors side by side, of 5 to 400 m.
void add_ground(SceneDescription& scene, Random& random, unsigned kind) {
    const double size = std::pow(10.0, random.between(0.7, 2.6)), thick = random.between(0.2, 2.0);
    const Vec3 whole(size, thick, size);
    if (kind == 0)
        scene.bodies.push_back(slab(Vec3::Zero(), whole, turned_about(Vec3::UnitY(), random.between(0.0, 1.5))));
    if (kind == 1) {
        const Vec3 axis = Vec3(random.between(-1.0, 1.0), 0.2, random.between(-1.0, 1.0)).normalized();
        scene.bodies.push_back(slab(Vec3::Zero(), whole, turned_about(axis, random.between(-0.6, 0.6))));
    }
    if (kind == 2) {  // some of the walls may be in front of the eye
        const double room = std::min(size, 30.0), high = random.between(2.0, 6.0);
        scene.bodies.push_back(slab(Vec3::Zero(), Vec3(room, thick, room)));
        scene.bodies.push_back(slab(Vec3(-0.5 * room, high, 0.0), Vec3(thick, high, room)));
        scene.bodies.push_back(slab(Vec3(0.0, high, -0.5 * room), Vec3(room, high, thick)));
        if (random.chance(0.5)) scene.bodies.push_back(slab(Vec3(0.5 * room, high, 0.0), Vec3(thick, high, room)));
    }
    if (kind == 3) {
        scene.bodies.push_back(slab(Vec3(-0.5 * size, 0.0, 0.0), whole));
        scene.bodies.push_back(slab(Vec3(0.5 * size, random.between(-0.5, 0.5), 0.0), whole));
    }
    for (BodyDescription& body : scene.bodies)
        if (random.chance(0.3)) body.appearance.pattern = Pattern::grid;
}

enum class Ground { boxes, curved };

SceneDescription random_scene(unsigned seed, Ground ground) {
    Random random(seed);
    SceneDescription scene = empty_scene();
    scene.output.width = 232;  // not a multiple of the tile size
    scene.output.height = 152;
    scene.output.samples = seed % 7 == 0 ? 1 : 4;
    scene.camera.eye = Vec3(random.between(-3.0, 3.0), random.between(0.5, 6.0), random.between(4.0, 12.0));
    scene.camera.target = Vec3(0.0, 0.3, 0.0);
    if (seed % 6 == 5) scene.camera.orbit = 40.0;
    scene.light.direction = Vec3(random.between(-1.0, 1.0), -random.between(0.1, 1.0), random.between(-1.0, 0.6));
    if (seed % 11 == 8) scene.light.direction = Vec3(0.6, -0.012, -0.8);  // infinitely long shadows
    scene.light.shadows = seed % 8 != 6;  // without shadows, changes of AO are not hidden
    if (ground == Ground::boxes)
        add_ground(scene, random, seed % 4);
    else
        add_curved_ground(scene, random, seed % 5);
    if (seed % 5 == 4) {
        scene.bodies.push_back(ground_plane(stone, Pattern::checker));
        scene.bodies.back().position.y() = -2.0;
    }
    const int count = 2 + int(random.between(0.0, 6.0));
    for (int i = 0; i < count; ++i) {
        const Vec3 size(random.between(0.2, 0.8), random.between(0.2, 0.8), random.between(0.2, 0.8));
        scene.bodies.push_back(i % 3 == 2 ? ball_body(Vec3::Zero(), 0.4 * size.x(), random.color())
                                          : box_body(Vec3::Zero(), size, random.color()));
        scene.bodies.back().position = random.vector(2.0, 1.0, 2.0) + Vec3(0.0, 1.2, 0.0);
        if (random.chance(0.2)) {
            scene.bodies.back().type = BodyType::kinematic;
            const Vec3 far = random.vector(5.0, 1.0, 5.0) + Vec3(0.0, 1.2, 0.0);
            scene.bodies.back().keyframes = {{0.0, scene.bodies.back().position, Quat::Identity()},
                                             {2.0, far, Quat::Identity()}};
        }
    }
    if (seed % 9 == 8) scene.bodies.push_back(mesh_body(Vec3(0.5, 0.8, 0.0), torus_asset(0.4, 0.15), random.color()));
    if (seed % 10 == 9)
        scene.cords.push_back({scene.bodies.size() - 1, Vec3(0.0, 0.1, 0.0), Vec3(0.5, 3.0, 0.0), 0.03, {60, 60, 60}});
    return scene;
}

// Some bodies stay; the others roll, fly off, leave the ground, or return.
void move(const SceneDescription& scene, Random& random, Snapshot& snapshot) {
    const double share = random.between(0.1, 0.8), way = std::pow(10.0, random.between(-3.0, -0.3));
    for (std::size_t i = 0; i < snapshot.bodies.size(); ++i) {
        BodyState& body = snapshot.bodies[i];
        if (scene.bodies[i].type == BodyType::fixed || !random.chance(share)) continue;
        body.origin += random.vector(way);
        if (random.chance(0.3)) body.origin = random.vector(3.0, 1.0, 3.0) + Vec3(0.0, 1.2, 0.0);
        if (random.chance(0.05)) body.origin = random.vector(std::pow(10.0, random.between(0.5, 2.5)));
        if (random.chance(0.6)) body.orientation = random.turn();
    }
}

std::size_t different_pixels(const Image& a, const Image& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4)
        count += !std::equal(&a.pixels[i], &a.pixels[i] + 4, &b.pixels[i]);
    return count;
}

// One renderer draws all frames, another every second one, like two workers. Returns the redrawn part of all frames.
double draw_partly(unsigned seeds, Ground ground) {
    RenderSwitches everything;
    everything.full_redraw = true;
    double redrawn = 0.0, frames = 0.0;
    for (unsigned seed = 0; seed < seeds; ++seed) {
        const SceneDescription scene = random_scene(seed, ground);
        Renderer partial(scene), second(scene), full(scene, everything);
        Random random(1000 + seed);
        Snapshot snapshot = first_snapshot(scene);
        for (int step = 0; step < 20; ++step) {
            if (step % 10 == 9) snapshot.time += 0.5;  // an orbiting camera moves
            const Image &frame = partial.render(snapshot), &truth = full.render(snapshot);
            EXPECT_EQ(different_pixels(frame, truth), 0u) << "scene " << seed << ", step " << step;
            if (step % 2 == 0) {
                EXPECT_EQ(different_pixels(second.render(snapshot), truth), 0u)
                    << "scene " << seed << ", step " << step << ", second worker";
            }
            if (frame != truth) return 1.0;
            for (const Rectangle& r : partial.changed()) redrawn += double(r.width) * r.height / (232.0 * 152.0);
            frames += 1.0;
            move(scene, random, snapshot);
        }
    }
    return redrawn / frames;
}

TEST(GroundRedraw, HasTheBytesOfAFullRedrawOnBoxes) {
    EXPECT_LT(draw_partly(24, Ground::boxes), 0.6) << "of the pictures: the test must have something to leave out";
}

TEST(GroundRedraw, HasTheBytesOfAFullRedrawOnMeshesAndBalls) {
    EXPECT_LT(draw_partly(30, Ground::curved), 0.6) << "of the pictures: the test must have something to leave out";
}

// A small movement on a large floor redraws no more than on a plane, for any bounding ball and far corners of the
// floor.
TEST(GroundRedraw, RedrawsLittleOnALargeBoxOrMesh) {
    const auto redrawn = [](const BodyDescription& ground) {
        SceneDescription scene = empty_scene();
        scene.camera.eye = Vec3(6.0, 4.0, 9.0);
        scene.bodies.push_back(ground);
        scene.bodies.push_back(box_body(Vec3(0.0, 0.5, 0.0), Vec3::Ones(), {200, 130, 60}));
        scene.bodies.push_back(box_body(Vec3(1.5, 0.5, 1.0), Vec3::Ones(), {200, 130, 60}));
        scene.bodies.push_back(ball_body(Vec3(-1.5, 0.6, 1.0), 0.6, {60, 110, 200}));
        Renderer renderer(scene);
        Snapshot snapshot = first_snapshot(scene);
        renderer.render(snapshot);
        snapshot.bodies[3].origin.x() += 0.01;
        const Image& frame = renderer.render(snapshot);
        double pixels = 0.0;
        for (const Rectangle& r : renderer.changed()) pixels += double(r.width) * r.height;
        return pixels / double(frame.width * frame.height);
    };
    const double on_plane = redrawn(ground_plane(stone));
    for (const double size : {20.0, 60.0, 200.0})
        EXPECT_LT(redrawn(slab(Vec3::Zero(), Vec3(size, 1.0, size))), 1.2 * on_plane) << size << " m";
    for (const double size : {20.0, 60.0}) {
        BodyDescription sheet = mesh_body(Vec3::Zero(), sheet_asset(size, 4), stone);
        sheet.type = BodyType::fixed;
        EXPECT_LT(redrawn(sheet), 1.5 * on_plane) << "a sheet of " << size << " m";
    }
}

}  // namespace
}  // namespace tumble::ground_redraw_test
