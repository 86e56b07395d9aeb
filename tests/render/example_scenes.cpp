#include "example_scenes.h"

#include "random.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

Quat turned(const Vec3& axis, double angle) {
    const SinCos half = sincos(0.5 * angle);
    const Vec3 v = axis.normalized() * half.sin;
    return {half.cos, v.x(), v.y(), v.z()};
}

Color pleasant_color(Random& random) {
    const double hue = random.between(0.0, 6.0), value = random.between(0.72, 0.95), tone = random.between(0.35, 0.75);
    const auto channel = [&](double shift) {
        const double h = std::fmod(hue + shift, 6.0), ramp = std::clamp(std::min(h, 4.0 - h), 0.0, 1.0);
        return std::uint8_t(255.0 * value * (1.0 - tone + tone * ramp));
    };
    return {channel(2.0), channel(0.0), channel(4.0)};
}

}  // namespace

SceneDescription empty_scene() {
    SceneDescription scene;
    scene.output.width = 320;
    scene.output.height = 180;
    scene.camera.eye = Vec3(0.0, 1.0, 8.0);
    scene.camera.target = Vec3(0.0, 1.0, 0.0);
    return scene;
}

BodyDescription ground_plane(Color color, Pattern pattern) {
    BodyDescription body;
    body.type = BodyType::fixed;
    body.shape = PlaneShape{};
    body.appearance.color = color;
    body.appearance.pattern = pattern;
    body.appearance.roughness = 0.8;
    return body;
}

BodyDescription box_body(const Vec3& position, const Vec3& size, Color color, const Quat& rotation) {
    BodyDescription body;
    body.shape = BoxShape{size};
    body.appearance.color = color;
    body.position = position;
    body.rotation = rotation;
    return body;
}

BodyDescription ball_body(const Vec3& position, double radius, Color color, const Quat& rotation) {
    BodyDescription body = box_body(position, Vec3::Ones(), color, rotation);
    body.shape = SphereShape{radius};
    body.appearance.roughness = 0.3;
    return body;
}

BodyDescription mesh_body(const Vec3& position, std::shared_ptr<const MeshAsset> asset, Color color,
                          const Quat& rotation) {
    BodyDescription body = box_body(position, Vec3::Ones(), color, rotation);
    body.shape = MeshShape{std::move(asset)};
    body.appearance.roughness = 0.35;
    return body;
}

std::shared_ptr<const MeshAsset> torus_asset(double ring_radius, double tube_radius, std::uint32_t around,
                                             std::uint32_t across) {
    auto asset = std::make_shared<MeshAsset>();
    for (std::uint32_t i = 0; i < around; ++i)
        for (std::uint32_t j = 0; j < across; ++j) {
            const SinCos a = sincos(2.0 * pi * i / around), b = sincos(2.0 * pi * j / across);
            const Vec3 normal(b.cos * a.sin, b.sin, b.cos * a.cos);
            const Vec3 p = Vec3(a.sin, 0.0, a.cos) * ring_radius + normal * tube_radius;
            asset->mesh.vertices.push_back(p);
            asset->vertices.push_back({{float(p.x()), float(p.y()), float(p.z())},
                                       {float(normal.x()), float(normal.y()), float(normal.z())}});
            const std::uint32_t next_i = (i + 1) % around, next_j = (j + 1) % across;
            const std::uint32_t corners[4] = {i * across + j, next_i * across + j, next_i * across + next_j,
                                              i * across + next_j};
            asset->mesh.triangles.push_back({corners[0], corners[1], corners[2]});
            asset->mesh.triangles.push_back({corners[0], corners[2], corners[3]});
        }
    for (const auto& t : asset->mesh.triangles) asset->indices.insert(asset->indices.end(), t.begin(), t.end());
    return asset;
}

std::shared_ptr<const MeshAsset> sheet_asset(double size, std::uint32_t cells) {
    auto asset = std::make_shared<MeshAsset>();
    for (std::uint32_t j = 0; j <= cells; ++j)
        for (std::uint32_t i = 0; i <= cells; ++i) {
            const Vec3 p = size * Vec3(double(i) / cells - 0.5, 0.0, double(j) / cells - 0.5);
            asset->mesh.vertices.push_back(p);
            asset->vertices.push_back({{float(p.x()), 0.0f, float(p.z())}, {0.0f, 1.0f, 0.0f}});
            if (i == cells || j == cells) continue;
            const std::uint32_t at = j * (cells + 1) + i, below = at + cells + 1;
            asset->mesh.triangles.push_back({at, below, below + 1});
            asset->mesh.triangles.push_back({at, below + 1, at + 1});
        }
    for (const auto& t : asset->mesh.triangles) asset->indices.insert(asset->indices.end(), t.begin(), t.end());
    return asset;
}

Snapshot first_snapshot(const SceneDescription& scene) {
    Snapshot snapshot;
    for (const BodyDescription& body : scene.bodies)
        snapshot.bodies.push_back({body.position, body.position, body.rotation, body.velocity, body.angular_velocity});
    return snapshot;
}

SceneDescription heap_scene(int count) {
    SceneDescription scene = empty_scene();
    scene.output.width = 1280;
    scene.output.height = 720;
    const double spread = 0.6 * std::sqrt(double(count));
    const double far = spread / 6.0;
    scene.camera.eye = Vec3(7.5, 5.5, 11.5) * far;
    scene.camera.target = Vec3(0.0, 1.1, 0.0) * far;
    scene.bodies.push_back(ground_plane());

    Random random(7);
    struct Standing {
        double x, z, radius, top;
    };
    std::vector<Standing> pile;
    for (int i = 0; i < count; ++i) {
        const Vec3 size(random.between(0.7, 1.25), random.between(0.7, 1.15), random.between(0.7, 1.25));
        const double angle = random.between(0.0, 2.0 * pi),
                     distance = spread * std::sqrt(random.between(0.0, 1.0)) * 0.85;
        const SinCos direction = sincos(angle);
        const double x = distance * direction.cos, z = distance * direction.sin;
        const double radius = 0.36 * (size.x() + size.z()) * 0.5;
        double base = 0.0;
        for (const Standing& other : pile)
            if (std::hypot(other.x - x, other.z - z) < other.radius + radius) base = std::max(base, other.top);
        const double tilt = base > 0.0 && random.between(0.0, 1.0) < 0.5 ? random.between(0.05, 0.5) : 0.0;
        const Quat rotation = turned(Vec3(direction.sin, 0.0, direction.cos), tilt) *
                              turned(Vec3::UnitY(), random.between(0.0, 2.0 * pi));
        scene.bodies.push_back(box_body(Vec3(x, base + 0.5 * size.y(), z), size, pleasant_color(random), rotation));
        pile.push_back({x, z, radius, base + size.y()});
    }
    return scene;
}

bool passes_through(const BodyDescription& box, const Vec3& start, const Vec3& way, double end) {
    const Vec3 half = 0.5 * std::get<BoxShape>(box.shape).size;
    const Vec3 from = box.rotation.conjugate() * (start - box.position), along = box.rotation.conjugate() * way;
    double enter = 0.0, leave = end;
    for (int k = 0; k < 3; ++k) {
        const double a = (-half[k] - from[k]) / along[k], b = (half[k] - from[k]) / along[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave;
}

SceneDescription scaled(SceneDescription scene, double factor) {
    scene.camera.eye *= factor;
    scene.camera.target *= factor;
    for (BodyDescription& body : scene.bodies) {
        body.position *= factor;
        if (auto* box = std::get_if<BoxShape>(&body.shape)) box->size *= factor;
        if (auto* ball = std::get_if<SphereShape>(&body.shape)) ball->radius *= factor;
        if (auto* plane = std::get_if<PlaneShape>(&body.shape)) plane->offset *= factor;
    }
    return scene;
}

SceneDescription moved(SceneDescription scene, const Vec3& by) {
    scene.camera.eye += by;
    scene.camera.target += by;
    for (BodyDescription& body : scene.bodies) body.position += by;
    return scene;
}

}  // namespace tumble
