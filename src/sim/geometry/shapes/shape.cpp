#include "sim/geometry/shapes/shape.h"

#include "core/check.h"

namespace tumble {

Bounds local_bounds(const Shape& shape) {
    return std::visit([](const auto& one) { return local_bounds(one); }, shape);
}

void visit_extent(const Shape& shape, const ExtentVisitor& visit) {
    std::visit([&](const auto& one) { visit_extent(one, visit); }, shape);
}

BoundingSphere bounding_sphere(const Shape& shape) {
    TUMBLE_CHECK_EQ(endless(shape), false);
    return std::visit([](const auto& one) { return bounding_sphere(one); }, shape);
}

MassProperties mass_properties(const Shape& shape, double density) {
    return std::visit([&](const auto& one) { return mass_properties(one, density); }, shape);
}

MassProperties mass_properties(const BodyDescription& body) {
    const MassProperties p = mass_properties(body.shape, body.density);
    return body.mass && p.mass > 0.0 ? with_mass(p, *body.mass) : p;
}

double first_hit(const Shape& shape, const Vec3& from, const Vec3& direction) {
    return std::visit([&](const auto& one) { return first_hit(one, from, direction); }, shape);
}

CollisionShape make_collider(const Shape& shape, const ColliderRequest& request, ColliderCache& cache) {
    return std::visit([&](const auto& one) { return make_collider(one, request, cache); }, shape);
}

const void* shared_data(const Shape& shape) {
    return std::visit(
        [](const auto& one) -> const void* {
            if constexpr (requires { one.asset; })
                return one.asset.get();
            else if constexpr (requires { one.parts; })
                return one.parts.get();
            else
                return nullptr;
        },
        shape);
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

ContactSurface contact_surface(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).contact_surface; }, collider);
}

std::uint32_t part_count(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).part_count(); }, collider);
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
