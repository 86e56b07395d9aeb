// Meshes. A body that moves collides as the convex hull of its mesh (hull.h), a fixed one as the mesh itself. Each
// triangle knows its neighbors, so that an internal edge does not catch a sliding body, and that a body beside a crease
// is on one side of both triangles.
#pragma once

#include "core/triangle_mesh.h"
#include "sim/geometry/shapes/interface.h"
#include "sim/math/bounds_tree.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

struct CollisionMesh {
    static constexpr std::uint32_t none = 0xffffffff;

    struct Triangle {
        std::array<std::uint32_t, 3> vertices{};
        Vec3 normal = Vec3::Zero();  // unit, by the winding
        // Corner opposite to edge i (from vertex i to i + 1) in the neighboring triangle; -1: a border edge, or one of
        // more than two triangles.
        std::array<std::int32_t, 3> across{-1, -1, -1};
        std::array<std::uint32_t, 3> edge{};  // index of edge i, shared with the neighbor
        // of open meshes: index of the connected component of consistently wound triangles, if there is one
        std::uint32_t sheet = none;
    };

    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    std::uint32_t edge_count = 0;
    BoundsTree tree;      // over the triangles, body frame
    double radius = 0.0;  // m, about the body's center
    bool closed = false;  // true: solid inside, only the outer side pushes. false: both sides push

    Vec3 corner(std::uint32_t triangle, int i) const { return vertices[triangles[triangle].vertices[std::size_t(i)]]; }

    /// True if a contact normal (from this mesh outward, unit) belongs to a triangle: beyond the corner or edge that is
    /// the triangle's farthest feature along it, the mesh must not extend farther.
    bool owns_normal(const Triangle& triangle, const Vec3& normal) const;

    // Vertices that an edge joins to vertex v: ring[ring_start[v]] up to ring[ring_start[v + 1]].
    std::vector<std::uint32_t> ring_start, ring;
    // Triangles at vertex v, stored in the same way.
    std::vector<std::uint32_t> fan_start, fan;

    static constexpr ContactSurface contact_surface = ContactSurface::triangles;
    static constexpr bool can_move = false;
    Bounds world_bounds(const Pose& pose) const { return posed_bounds(tree.bounds(), pose); }
    double bounding_radius() const { return radius; }
    double depth() const { return infinity; }
    double mean_projected_area() const { return 0.0; }
    RoundedHull rounded_hull() const { return {{&origin_point, 1}}; }
    std::uint32_t part_count() const { return std::uint32_t(triangles.size()); }
};

/// Throws InputError when no triangle has an area.
CollisionMesh make_collision_mesh(const TriangleMesh& mesh, const Vec3& origin);

struct NearestOnTriangle {
    Vec3 point;
    int feature;  // 0 face, 1 to 3 edge, 4 to 6 vertex
};

/// Nearest point of a triangle with its feature (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
NearestOnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

void visit_extent(const MeshShape& mesh, const ExtentVisitor& visit);
/// A solid bounded by a closed, outward-facing triangle mesh, by exact integration over the tetrahedra from one point
/// (Tonon 2004, "Explicit exact formulas for the 3-D tetrahedron inertia tensor"; Blow and Binstock 2004).
MassProperties mesh_mass(const TriangleMesh& mesh, double density);
/// Zero for an open mesh.
MassProperties mass_properties(const MeshShape& mesh, double density);
double first_hit(const MeshShape& mesh, const Vec3& from, const Vec3& direction);
/// Throws InputError for a mesh without a hull, or without a triangle with an area.
CollisionShape make_collider(const MeshShape& mesh, const ColliderRequest& request, ColliderCache& cache);

}  // namespace tumble
