// A convex polyhedron: the collision shape of boxes (box.h) and of meshes that move (as their hulls).
// Frame: the body's, with its center of mass at the origin. Faces are true polygons (coplanar triangles are one face),
// so that two boxes meet in a four-cornered manifold and every feature has a stable index.
#pragma once

#include "core/triangle_mesh.h"
#include "sim/geometry/shapes/interface.h"
#include "sim/math/bounds_tree.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

struct Polyhedron {
    struct Face {
        Vec3 normal = Vec3::Zero();           // unit, outward
        double offset = 0.0;                  // normal . p = offset on the face, m
        std::vector<std::uint32_t> vertices;  // counterclockwise seen from outside
    };
    struct Edge {
        std::uint32_t tail = 0, head = 0;   // vertices
        std::uint32_t left = 0, right = 0;  // faces: `left` has the edge from tail to head
    };

    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Edge> edges;
    Bounds bounds;        // of the vertices
    double radius = 0.0;  // m, largest distance of a vertex from the center of mass
    // m, least distance of a face's plane from the center of mass; 0 if that lies outside
    double inner_radius = 0.0;
    BoundsTree edge_tree;  // over the edges, to find edges that reach into a region
    std::vector<std::uint32_t> first_neighbor,
        neighbors;                    // of vertex i: [first_neighbor[i], first_neighbor[i + 1])
    bool is_box = false;              // box: faces 2k and 2k+1 have normals +k and -k, which shortens axis searches
    Vec3 half_extent = Vec3::Zero();  // m, of a box

    /// The vertex farthest along a direction (body frame), found by climbing from vertex `start` along edges: in a
    /// convex shape, a vertex farther than all its neighbors is the farthest of all.
    std::uint32_t support(const Vec3& direction, std::uint32_t start = 0) const;
    /// The face that meets a plane normal to a direction (unit): of those at the farthest vertex, the face with most
    /// vertices no farther than `depth` (m) behind it, then the one best aligned with the direction. The best aligned
    /// face of the whole shape need not touch the plane at all.
    std::uint32_t face_at_support(const Vec3& direction, double depth) const;
    double surface_area() const;

    /// Derives planes, edges, bounds and radius from vertices and face loops.
    void complete();

    static constexpr ContactSurface contact_surface = ContactSurface::polyhedral;
    static constexpr bool can_move = true;
    Bounds world_bounds(const Pose& pose) const {
        return is_box ? posed_bounds(pose.position, half_extent, pose) : posed_bounds(bounds, pose);
    }
    double bounding_radius() const { return radius; }
    double depth() const { return inner_radius; }
    double mean_projected_area() const { return 0.25 * surface_area(); }  // Cauchy 1832
    RoundedHull rounded_hull() const { return {vertices, radius}; }
    std::uint32_t part_count() const { return 1; }
    /// True if a point lies in the shape, or no farther than `tolerance` (m) outside of its planes.
    bool contains(const Vec3& point, double tolerance) const;
};

/// The convex hull of points (Qhull), about `origin` as the new center. Throws InputError when the points have no
/// volume.
Polyhedron make_hull(const std::vector<Vec3>& points, const Vec3& origin);

/// The polyhedron that a closed convex mesh encloses, about `origin`; empty for another mesh. Unlike Qhull, whose hash
/// tables depend on addresses, it merges many coplanar triangles always in the same way.
std::optional<Polyhedron> convex_polyhedron(const TriangleMesh& mesh, const Vec3& origin);

}  // namespace tumble
