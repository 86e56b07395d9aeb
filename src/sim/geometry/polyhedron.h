// A convex polyhedron: the collision shape of boxes and of meshes (as their hulls).
// Frame: the body's, with its centre of mass at the origin. Faces are true polygons (coplanar triangles are one face),
// so that two boxes meet in a four-cornered manifold and every feature has a stable index.
#pragma once

#include "core/vector.h"
#include "sim/geometry/bounds_tree.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct Polyhedron {
    struct Face {
        Vec3 normal = Vec3::Zero();            // unit, outward
        double offset = 0.0;                   // normal . p = offset on the face, m
        std::vector<std::uint32_t> vertices;   // counter-clockwise seen from outside
    };
    struct Edge {
        std::uint32_t tail = 0, head = 0;      // vertices
        std::uint32_t left = 0, right = 0;     // faces: `left` has the edge from tail to head
    };

    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    std::vector<Edge> edges;
    Bounds bounds;                             // of the vertices
    double radius = 0.0;                       // m, largest distance of a vertex from the centre of mass
    double inner_radius = 0.0;                 // m, least distance of a face's plane from it; 0 if it lies outside
    BoundsTree edge_tree;                      // over the edges: which of them reach into a region
    std::vector<std::uint32_t> first_neighbour, neighbours;   // of vertex i: [first_neighbour[i], first_neighbour[i + 1])
    bool is_box = false;                       // faces 2k and 2k+1 look along +k and -k: axis searches can be short
    Vec3 half_extent = Vec3::Zero();           // of a box

    /// The vertex farthest along a direction (body frame), found by climbing from vertex `start` along edges: what is
    /// farther than all its neighbours is farthest of all, the shape being convex.
    std::uint32_t support(const Vec3& direction, std::uint32_t start = 0) const;
    /// The face that meets a plane across a direction (unit): of those at the farthest vertex, the one with most vertices
    /// no farther than `depth` (m) behind it, then the one that looks most that way. The face that looks most along a
    /// direction without regard to the vertex need not touch the plane at all.
    std::uint32_t face_at_support(const Vec3& direction, double depth) const;
    double surface_area() const;

    /// Derives planes, edges, bounds and radius from vertices and face loops.
    void complete();
};

/// A box of the given full edge lengths about the origin.
Polyhedron make_box(const Vec3& size);

/// The convex hull of points (Qhull), about `origin` as the new centre. Throws InputError when the points have no volume.
Polyhedron make_hull(const std::vector<Vec3>& points, const Vec3& origin);

}  // namespace tumble
