#include "scene/description/shape_bounds.h"

#include "core/check.h"

#include <algorithm>

namespace tumble {
namespace {

/// Calls visit(center, radius) for balls, most of them points, whose convex hull contains the shape. Not for planes.
template <class Visit>
void visit_extent(const Shape& shape, const Vec3& position, const Quat& rotation, const Visit& visit) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) {
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
            visit(Vec3(position + rotation * sign.cwiseProduct(box->size)), 0.0);
        }
    } else if (const auto* ball = std::get_if<SphereShape>(&shape)) {
        visit(position, ball->radius);
    } else if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
        for (const Vec3& v : mesh->asset->mesh.vertices) visit(Vec3(position + rotation * v), 0.0);
    } else if (const auto* compound = std::get_if<CompoundShape>(&shape)) {
        for (const CompoundPart& part : *compound->parts)
            visit_extent(part.shape, position + rotation * part.position, rotation * part.rotation, visit);
    }
}

}  // namespace

const void* shared_data(const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh->asset.get();
    if (const auto* compound = std::get_if<CompoundShape>(&shape)) return compound->parts.get();
    return nullptr;
}

Bounds local_bounds(const Shape& shape) {
    if (const auto* box = std::get_if<BoxShape>(&shape)) return {-0.5 * box->size, 0.5 * box->size};
    if (const auto* ball = std::get_if<SphereShape>(&shape)) {
        return {Vec3::Constant(-ball->radius), Vec3::Constant(ball->radius)};
    }
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh->asset->mesh.bounds();
    Bounds bounds;  // of a compound
    visit_extent(shape, Vec3::Zero(), Quat::Identity(), [&](const Vec3& p, double r) {
        bounds.add(p.array() - r);
        bounds.add(p.array() + r);
    });
    return bounds;
}

BoundingSphere bounding_sphere(const Shape& shape) {
    TUMBLE_CHECK_EQ(std::holds_alternative<PlaneShape>(shape), false);
    if (const auto* ball = std::get_if<SphereShape>(&shape)) return {Vec3::Zero(), ball->radius};
    const Bounds bounds = local_bounds(shape);
    BoundingSphere sphere{bounds.center(), 0.5 * bounds.extent().norm()};
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
        double farthest = 0.0;  // square of the distance
        for (const Vec3& v : mesh->asset->mesh.vertices) {
            farthest = std::max(farthest, (v - sphere.center).squaredNorm());
        }
        sphere.radius = std::sqrt(farthest);
    } else if (std::holds_alternative<CompoundShape>(shape)) {
        sphere.radius = 0.0;
        visit_extent(shape, Vec3::Zero(), Quat::Identity(), [&](const Vec3& p, double r) {
            sphere.radius = std::max(sphere.radius, (p - sphere.center).norm() + r);
        });
    }
    return sphere;
}

}  // namespace tumble
