// The interface of a kind of shape: the content of its file in this folder. shape.h calls it for a shape of any kind.
//
// A shape is described by plain values in its body's frame: BoxShape and the other kinds of Shape. It collides as a
// collision shape, whose origin is the center of mass and which has these members:
//   Bounds world_bounds(const Pose&) const  m; infinite for a half-space
//   double bounding_radius() const          m, of the farthest point from the center of mass
//   double depth() const                    m, to which another shape may penetrate and still be pushed back out of the
//                                           side that it came in by: the inner radius. Infinity for half-spaces and
//                                           meshes, where the thickness of the other shape counts
//   double mean_projected_area() const      m^2, over all directions; 0 for a shape that never moves freely
//   RoundedHull rounded_hull() const        for the time of impact
//   ContactSurface contact_surface          the features that touch others
//   bool can_move                           false: two of them never collide
//   std::uint32_t part_count() const        number of values of Manifold::part in a pair
//   bool contains(const Vec3& point, double tolerance) const  (m) of a part of a compound
//   double rolling_radius() const           m, of a surface that rolls; shapes with corners have none
#pragma once

#include "core/vector.h"
#include "scene/description/description.h"
#include "sim/math/mass_properties.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <tuple>
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

/// Bounding box (world) of a box with this center (world) and the axes of the pose: |R| times the half extents (Ericson
/// 2005, "Real-Time Collision Detection", 4.2.6).
inline Bounds posed_bounds(const Vec3& center, const Vec3& half_extent, const Pose& pose) {
    const Vec3 half = pose.rotation.cwiseAbs() * half_extent;
    return {center - half, center + half};
}
/// Bounding box (world) of a posed box.
inline Bounds posed_bounds(const Bounds& local, const Pose& pose) {
    return posed_bounds(pose.to_world(local.center()), 0.5 * local.extent(), pose);
}

struct BoundingSphere {
    Vec3 center = Vec3::Zero();  // body frame
    double radius = 0.0;         // m
};

/// Takes the center (m, the shape's frame) and the radius (m; 0: a point) of a ball.
using ExtentVisitor = std::function<void(const Vec3& center, double radius)>;

/// Points whose convex hull, rounded by a radius, is a convex shape; the origin for all others. Refers to its shape.
struct RoundedHull {
    std::span<const Vec3> points;  // m, body frame; at least one
    double reach = 0.0;            // m, distance of the farthest point from the center of mass
    double radius = 0.0;           // m
};
inline const Vec3 origin_point = Vec3::Zero();

/// Features by which a collision shape touches others: a plane; a curved surface; corners, edges and faces; triangles
/// on either side; those of several parts; or discs, rims, round sides and tips.
enum class ContactSurface : std::uint8_t { plane, curved, polyhedral, triangles, parts, round };

struct HalfSpace;
struct Ball;
struct Polyhedron;
struct CollisionMesh;
struct Compound;
struct CurvedBody;
/// Shared by bodies with the same shape, so that a hull is built once.
using CollisionShape =
    std::variant<HalfSpace, Ball, std::shared_ptr<const Polyhedron>, std::shared_ptr<const CollisionMesh>,
                 std::shared_ptr<const Compound>, std::shared_ptr<const CurvedBody>>;

struct ColliderRequest {
    bool fixed = false;          // the body never moves: a mesh collides as it is, not as its convex hull
    Vec3 origin = Vec3::Zero();  // m, of the collision shape, in the described shape's frame: the center of mass
    double density = 1000.0;     // kg/m^3
};

/// Collision shapes that have been made: equal boxes share one, and so do bodies of the same mesh or compound.
struct ColliderCache {
    struct Mesh {
        std::shared_ptr<const Polyhedron> hull;
        std::shared_ptr<const CollisionMesh> surface;
    };
    struct Whole {
        Vec3 origin = Vec3::Zero();
        std::shared_ptr<const Compound> made;
    };
    std::map<std::array<double, 3>, std::shared_ptr<const Polyhedron>> boxes;  // by edge lengths: each takes 2 KB
    // By the address of their data: looked up only, never iterated. The source of the mass decides their origin.
    std::map<std::tuple<const MeshAsset*, MassFrom, double>, Mesh> meshes;
    std::map<const void*, Whole> compounds;
    std::map<std::array<double, 8>, std::shared_ptr<const CurvedBody>> curved;  // by the values of the shape
};

// The functions of a described shape. A kind without one does not compile where a shape of any kind has it.

/// Visits balls and points whose convex hull contains the shape; none for a plane.
template <class Kind>
void visit_extent(const Kind&, const ExtentVisitor&) = delete;
/// Zero without a volume. `density`: kg/m^3.
template <class Kind>
MassProperties mass_properties(const Kind&, double density) = delete;
/// The first point of the surface on a ray, as a multiple of `direction`; infinity without a hit.
template <class Kind>
double first_hit(const Kind&, const Vec3& from, const Vec3& direction) = delete;
/// All lengths by a factor; of meshes and compounds by MeshCache.
template <class Kind>
Kind enlarged(const Kind&, double factor) = delete;
/// Declared without its CollisionShape, which is complete only after the kinds.
template <class Kind>
void make_collider(const Kind&, const ColliderRequest&, ColliderCache&) = delete;

}  // namespace tumble
