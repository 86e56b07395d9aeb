#include "sim/geometry/shapes/shape.h"

#include "core/check.h"

#include <algorithm>

namespace tumble {

Bounds local_bounds(const Shape& shape) {
    Bounds bounds;
    visit_extent(shape, [&](const Vec3& center, double radius) {
        bounds.add(Vec3(center.array() - radius));
        bounds.add(Vec3(center.array() + radius));
    });
    return bounds;
}

void visit_extent(const Shape& shape, const ExtentVisitor& visit) {
    std::visit([&](const auto& one) { visit_extent(one, visit); }, shape);
}

BoundingSphere bounding_sphere(const Shape& shape) {
    TUMBLE_CHECK_EQ(endless(shape), false);
    BoundingSphere sphere{local_bounds(shape).center(), 0.0};
    visit_extent(shape, [&](const Vec3& center, double radius) {
        sphere.radius = std::max(sphere.radius, (center - sphere.center).norm() + radius);
    });
    return sphere;
}

MassProperties mass_properties(const Shape& shape, double density) {
    return std::visit([&](const auto& one) { return mass_properties(one, density); }, shape);
}

MassProperties mass_properties(const BodyDescription& body) {
    MassProperties p = mass_properties(body.shape, body.density);
    if (body.mass && p.mass > 0.0) p = with_mass(p, *body.mass);
    if (body.center_of_mass) p.center_of_mass = *body.center_of_mass;
    if (body.inertia) {
        const auto& [xx, yy, zz, xy, xz, yz] = *body.inertia;
        p.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    }
    return p;
}

double first_hit(const Shape& shape, const Vec3& from, const Vec3& direction) {
    return std::visit([&](const auto& one) { return first_hit(one, from, direction); }, shape);
}

CollisionShape make_collider(const Shape& shape, const ColliderRequest& request, ColliderCache& cache) {
    return std::visit([&](const auto& one) { return make_collider(one, request, cache); }, shape);
}

const void* shared_data(const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) return mesh->asset.get();
    if (const auto* compound = std::get_if<CompoundShape>(&shape)) return compound->parts.get();
    return nullptr;
}

Bounds world_bounds(const CollisionShape& collider, const Pose& pose) {
    return std::visit([&](const auto& held) { return collider_in(held).world_bounds(pose); }, collider);
}

double bounding_radius(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).bounding_radius(); }, collider);
}

double depth(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).depth(); }, collider);
}

double mean_projected_area(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).mean_projected_area(); }, collider);
}

RoundedHull rounded_hull(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).rounded_hull(); }, collider);
}

std::uint32_t part_count(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).part_count(); }, collider);
}

double rolling_radius(const CollisionShape& collider) {
    return std::visit(
        [](const auto& held) {
            if constexpr (requires { collider_in(held).rolling_radius(); })
                return collider_in(held).rolling_radius();
            else
                return 0.0;
        },
        collider);
}

bool contains(const CollisionShape& collider, const Vec3& point, double tolerance) {
    return std::visit(
        [&](const auto& held) {
            if constexpr (requires { collider_in(held).contains(point, tolerance); })
                return collider_in(held).contains(point, tolerance);
            else
                return false;
        },
        collider);
}

}  // namespace tumble
