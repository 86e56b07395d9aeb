#include "overlay/crack_sketch.h"

#include "sim/geometry/shapes/shape.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble {
namespace {

constexpr double flat = 1e-5;  // of the size of the whole: drawn vertices are single precision

/// The face of a drawn piece in the plane of a bond. Each face of a piece is a fan with vertices of its own.
std::vector<Vec3> face_in(const MeshAsset& asset, const Bond& bond, double tolerance) {
    const auto vertex = [&](std::uint32_t i) {
        const float* p = asset.vertices[i].position;
        return Vec3(p[0], p[1], p[2]);
    };
    const auto in_plane = [&](const Vec3& p) { return std::abs(bond.normal.dot(p - bond.center)) < tolerance; };
    std::vector<Vec3> outline;
    std::uint32_t first = 0;
    for (std::size_t t = 0; t + 2 < asset.indices.size(); t += 3) {
        const Vec3 p = vertex(asset.indices[t]), q = vertex(asset.indices[t + 1]), r = vertex(asset.indices[t + 2]);
        if (!outline.empty() && asset.indices[t] == first) {
            outline.push_back(r);
            continue;
        }
        if (!outline.empty()) break;
        if (!in_plane(p) || !in_plane(q) || !in_plane(r)) continue;
        first = asset.indices[t];
        outline = {p, q, r};
    }
    if (!outline.empty()) outline.push_back(outline.front());
    return outline;
}

bool shows_cracks(const SceneDescription& scene, std::size_t body) {
    const std::vector<std::size_t>& chosen = scene.overlay.bodies;
    if (!scene.bodies[body].fracture) return false;
    if (chosen.empty()) return scene.bodies[body].appearance.visible;
    return std::ranges::find(chosen, body) != chosen.end();
}

}  // namespace

std::vector<CrackSketch> sketch_cracks(const SceneDescription& scene) {
    std::vector<CrackSketch> sketches;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!shows_cracks(scene, i)) continue;
        const FractureDescription& fracture = *scene.bodies[i].fracture;
        const double tolerance = flat * bounding_sphere(scene.bodies[i].shape).radius;
        for (const Bond& bond : fracture.bonds) {
            if (bond.b == Bond::world) continue;
            const std::size_t a = fracture.first_piece + bond.a, b = fracture.first_piece + bond.b;
            const auto* mesh = std::get_if<MeshShape>(&scene.bodies[a].shape);
            if (mesh == nullptr) continue;
            sketches.push_back({i, a, b, face_in(*mesh->asset, bond, tolerance)});
        }
    }
    return sketches;
}

}  // namespace tumble
