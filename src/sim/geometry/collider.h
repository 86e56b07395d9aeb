// Collision shape of a body: a half-space, a sphere, a convex polyhedron, a triangle mesh, or several convex shapes
// together.
// Frame: the body's, with its center of mass at the origin.
#pragma once

#include "core/vector.h"
#include "sim/geometry/mesh_shape.h"
#include "sim/geometry/polyhedron.h"

#include <memory>
#include <variant>

namespace tumble {

/// Pose of a body: p_world = position + rotation * p_body (notes eq. 5).
struct Pose {
    Vec3 position = Vec3::Zero();
    Mat3 rotation = Mat3::Identity();

    Vec3 to_world(const Vec3& p) const { return position + rotation * p; }
    Vec3 to_body(const Vec3& p) const { return rotation.transpose() * (p - position); }
};

/// The given pose in the frame of another one.
inline Pose seen_from(const Pose& frame, const Pose& pose) {
    return {frame.to_body(pose.position), frame.rotation.transpose() * pose.rotation};
}

struct HalfSpace {
    Vec3 normal;    // unit; solid below
    double offset;  // m
};
struct Ball {
    double radius;  // m; the center is the body's origin
};

struct Compound;  // sim/geometry/compound.h

/// Shared by bodies with the same mesh, so that a hull is built once.
using CollisionShape = std::variant<HalfSpace, Ball, std::shared_ptr<const Polyhedron>,
                                    std::shared_ptr<const CollisionMesh>, std::shared_ptr<const Compound>>;

/// Bounding box (world) of a posed box.
Bounds posed_bounds(const Bounds& local, const Pose& pose);
/// World bounds of a posed shape; infinite for a half-space.
Bounds world_bounds(const CollisionShape& collider, const Pose& pose);

/// Distance of the farthest point from the center of mass, m; infinity for a half-space.
double bounding_radius(const CollisionShape& collider);

/// Depth (m) to which another shape may penetrate and still be pushed back out of the side that it came in by: the
/// inner radius. Infinity for half-spaces and meshes, where the thickness of the other shape counts.
double depth(const CollisionShape& collider);

}  // namespace tumble
