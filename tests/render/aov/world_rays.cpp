#include "world_rays.h"

namespace tumble {
namespace {

/// The ray in the body's frame.
WorldRay in_body(const WorldRay& ray, const BodyState& state) {
    const Quat back = state.orientation.conjugate();
    return {back * (ray.eye - state.origin), back * ray.direction};
}

/// Intersects each face that is turned to the eye, within its rectangle.
double depth_of(const BoxShape& box, const WorldRay& ray) {
    for (int k = 0; k < 3; ++k)
        for (const double side : {-1.0, 1.0}) {
            const double face = side * 0.5 * box.size[k];
            if (!(side * (ray.eye[k] - face) > 0.0) || ray.direction[k] == 0.0) continue;
            const double depth = (face - ray.eye[k]) / ray.direction[k];
            const Vec3 p = ray.at(depth);
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            if (depth > 0.0 && std::abs(p[a]) <= 0.5 * box.size[a] && std::abs(p[b]) <= 0.5 * box.size[b]) return depth;
        }
    return -1.0;
}

double depth_of(const SphereShape& ball, const WorldRay& ray) {
    const double a = ray.direction.squaredNorm(), b = ray.direction.dot(ray.eye);
    const double c = ray.eye.squaredNorm() - ball.radius * ball.radius;
    if (c <= 0.0 || b * b < a * c) return -1.0;
    return (-b - std::sqrt(b * b - a * c)) / a;
}

double depth_of(const PlaneShape& plane, const WorldRay& ray) {
    const double height = plane.normal.dot(ray.eye) - plane.offset;
    return height > 0.0 ? -height / plane.normal.dot(ray.direction) : -1.0;
}

// Moller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection
double triangle_depth(const Vec3& a, const Vec3& b, const Vec3& c, const WorldRay& ray) {
    const Vec3 ab = b - a, ac = c - a, p = ray.direction.cross(ac);
    const double volume = ab.dot(p);
    if (volume <= 0.0) return -1.0;  // from behind
    const Vec3 from = ray.eye - a, q = from.cross(ab);
    const double u = from.dot(p) / volume, v = ray.direction.dot(q) / volume;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) return -1.0;
    return ac.dot(q) / volume;
}

double depth_of(const MeshShape& mesh, const WorldRay& ray) {
    const MeshAsset& asset = *mesh.asset;
    const auto corner = [&](std::size_t i) {
        const MeshAsset::Vertex& v = asset.vertices[asset.indices[i]];
        return Vec3(v.position[0], v.position[1], v.position[2]);
    };
    double nearest = -1.0;
    for (std::size_t i = 0; i < asset.indices.size(); i += 3) {
        const double depth = triangle_depth(corner(i), corner(i + 1), corner(i + 2), ray);
        if (depth > 0.0 && (nearest < 0.0 || depth < nearest)) nearest = depth;
    }
    return nearest;
}

/// The triangles that stand for it.
double depth_of(const CurvedShape& shape, const WorldRay& ray) { return depth_of(MeshShape{shape.drawn}, ray); }

double depth_of(const CompoundShape&, const WorldRay&) { return -1.0; }

}  // namespace

WorldHit nearest_in_world(const SceneDescription& scene, const Snapshot& snapshot, const WorldRay& ray) {
    WorldHit hit;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (!scene.bodies[i].appearance.visible) continue;
        const WorldRay local = in_body(ray, snapshot.bodies[i]);
        hit.add(std::visit([&](const auto& shape) { return depth_of(shape, local); }, scene.bodies[i].shape), i);
    }
    return hit;
}

}  // namespace tumble
