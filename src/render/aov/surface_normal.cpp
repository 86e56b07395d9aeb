#include "render/aov/surface_normal.h"

#include "render/aov/mesh_depths.h"

#include <array>
#include <limits>

namespace tumble {
namespace {

Vec3 normal_of(const PlaneShape& plane, const PartPlace&, std::uint32_t, const Vec3&, double) { return plane.normal; }

/// Normal of the face through which the ray enters: the one whose plane it crosses last.
Vec3 normal_of(const BoxShape& box, const PartPlace& place, std::uint32_t, const Vec3& ray, double) {
    int last = 0;
    double last_depth = -std::numeric_limits<double>::infinity(), side = 1.0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = place.axes.col(k);
        const double along = axis.dot(ray);
        if (along == 0.0) continue;
        const double towards_eye = along > 0.0 ? -1.0 : 1.0;
        const double depth = (axis.dot(place.origin) + towards_eye * 0.5 * box.size[k]) / along;
        if (!(depth > last_depth)) continue;
        last = k;
        last_depth = depth;
        side = towards_eye;
    }
    return side * Vec3::Unit(last);
}

Vec3 normal_of(const SphereShape&, const PartPlace& place, std::uint32_t, const Vec3& ray, double depth) {
    return (place.axes.transpose() * (depth * ray - place.origin)).normalized();
}

Vec3 normal_of(const MeshShape& mesh, const PartPlace& place, std::uint32_t triangle, const Vec3& ray, double) {
    std::array<Vec3, 3> corners, normals;
    for (std::size_t i = 0; i < 3; ++i) {
        const MeshAsset::Vertex& v = mesh.asset->vertices[mesh.asset->indices[3 * std::size_t(triangle) + i]];
        corners[i] = place.origin + place.axes * Vec3(v.position[0], v.position[1], v.position[2]);
        normals[i] = Vec3(v.normal[0], v.normal[1], v.normal[2]);
    }
    const std::array<double, 3> shares = corner_shares(corners, ray);
    const Vec3 flat = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    Vec3 normal = shares[0] * normals[0] + shares[1] * normals[1] + shares[2] * normals[2];
    if (!(normal.norm() > 0.0)) normal = place.axes.transpose() * flat;
    return (flat.dot(ray) > 0.0 ? -1.0 : 1.0) * normal.normalized();
}

Vec3 normal_of(const CompoundShape&, const PartPlace&, std::uint32_t, const Vec3&, double) { return Vec3::Zero(); }

}  // namespace

Vec3 part_normal(const ShapeInstance& part, const PartPlace& place, std::uint32_t triangle, const Vec3& ray,
                 double depth) {
    return std::visit([&](const auto& shape) { return normal_of(shape, place, triangle, ray, depth); }, part.shape);
}

Vec3 cord_normal(const CordPlace& place, const Vec3& point) {
    const Vec3 axis = (place.to - place.from).normalized();
    const Vec3 out = point - place.from;
    const double length = (place.to - place.from).norm(), along = axis.dot(out), near = 1e-9 * length;
    if (along <= near || along >= length - near) return along <= near ? Vec3(-axis) : axis;
    return (out - axis.dot(out) * axis).normalized();
}

}  // namespace tumble
