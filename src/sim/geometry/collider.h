// What of a body collides: a half-space, a sphere, a convex polyhedron, a triangle surface as it is, or several convex
// shapes together.
// Frame: the body's, with its centre of mass at the origin.
#pragma once

#include "core/vector.h"
#include "sim/geometry/polyhedron.h"
#include "sim/geometry/mesh_shape.h"

#include <memory>
#include <variant>

namespace tumble {

/// Where a body is: p_world = position + rotation * p_body (notes eq. 5).
struct Pose {
    Vec3 position = Vec3::Zero();
    Mat3 rotation = Mat3::Identity();

    Vec3 to_world(const Vec3& p) const { return position + rotation * p; }
    Vec3 to_body(const Vec3& p) const { return rotation.transpose() * (p - position); }
};

/// A pose in another one's frame.
inline Pose seen_from(const Pose& frame, const Pose& pose) {
    return {frame.to_body(pose.position), frame.rotation.transpose() * pose.rotation};
}

struct HalfSpace {
    Vec3 normal;      // unit; solid below
    double offset;    // m
};
struct Ball {
    double radius;    // m
};

struct Compound;   // sim/collision/compound.h

/// Shared where bodies share a mesh: a hull is built once.
using CollisionShape = std::variant<HalfSpace, Ball, std::shared_ptr<const Polyhedron>, std::shared_ptr<const CollisionMesh>,
                              std::shared_ptr<const Compound>>;

/// World bounds of a posed collider; a half-space's are infinite.
Bounds world_bounds(const CollisionShape& collider, const Pose& pose);

/// Distance of the farthest point from the centre of mass, m; infinity for a half-space.
double bounding_radius(const CollisionShape& collider);

/// How far something may come into the shape and still be pushed back out of the side it came in by, m: the inner radius;
/// infinity for half-spaces and surfaces, where what counts is how thin the other shape is.
double depth(const CollisionShape& collider);

}  // namespace tumble
