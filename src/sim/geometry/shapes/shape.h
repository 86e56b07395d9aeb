// Shapes of any kind: each function calls that of the kind (interface.h).
#pragma once

#include "sim/geometry/shapes/box.h"
#include "sim/geometry/shapes/compound.h"
#include "sim/geometry/shapes/curved.h"
#include "sim/geometry/shapes/hull.h"
#include "sim/geometry/shapes/mesh.h"
#include "sim/geometry/shapes/plane.h"
#include "sim/geometry/shapes/sphere.h"

namespace tumble {

/// Axis-aligned, m; empty for a plane.
Bounds local_bounds(const Shape& shape);
void visit_extent(const Shape& shape, const ExtentVisitor& visit);
/// About the center of the bounds. Not for planes.
BoundingSphere bounding_sphere(const Shape& shape);
MassProperties mass_properties(const Shape& shape, double density);
/// With the body's densities, or its mass, and the center of mass and the inertia that it is given.
MassProperties mass_properties(const BodyDescription& body);
double first_hit(const Shape& shape, const Vec3& from, const Vec3& direction);
CollisionShape make_collider(const Shape& shape, const ColliderRequest& request, ColliderCache& cache);

/// Address of the shared data of a mesh or a compound; null for other shapes.
const void* shared_data(const Shape& shape);

/// The collision shape of an alternative of CollisionShape: itself, or of the pointer to it.
template <class T>
const T& collider_in(const T& held) {
    return held;
}
template <class T>
const T& collider_in(const std::shared_ptr<const T>& held) {
    return *held;
}

Bounds world_bounds(const CollisionShape& collider, const Pose& pose);
double bounding_radius(const CollisionShape& collider);
double depth(const CollisionShape& collider);
double mean_projected_area(const CollisionShape& collider);
RoundedHull rounded_hull(const CollisionShape& collider);
inline ContactSurface contact_surface(const CollisionShape& collider) {
    return std::visit([](const auto& held) { return collider_in(held).contact_surface; }, collider);
}
std::uint32_t part_count(const CollisionShape& collider);
/// m; 0 for shapes that do not roll.
double rolling_radius(const CollisionShape& collider);
/// Precondition: a part of a compound.
bool contains(const CollisionShape& collider, const Vec3& point, double tolerance);

}  // namespace tumble
