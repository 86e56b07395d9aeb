// A fixed triangle mesh that collides as it is. Each triangle knows what lies beyond its border, so that a body sliding
// over a seam between two triangles is not caught by it, and that a body beside a crease is on one side of both.
#pragma once

#include "core/triangle_mesh.h"
#include "core/vector.h"
#include "sim/geometry/bounds_tree.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

struct CollisionMesh {
    static constexpr std::uint32_t none = 0xffffffff;

    struct Triangle {
        std::array<std::uint32_t, 3> vertices{};
        Vec3 normal = Vec3::Zero();                       // unit, by the winding
        // Corner opposite to edge i (from vertex i to i + 1) in the triangle beyond it; -1: the edge is open or crowded.
        std::array<std::int32_t, 3> across{-1, -1, -1};
        std::array<std::uint32_t, 3> edge{};              // index of edge i, shared with the neighbour
        std::uint32_t sheet = none;   // of open surfaces: of triangles joined by edges and wound alike, where that can be
    };

    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    std::uint32_t edge_count = 0;
    BoundsTree tree;                                // over the triangles, body frame
    double radius = 0.0;                            // m, about the body's centre
    bool closed = false;                            // solid inside: only the outer side pushes. Open: both sides do

    Vec3 corner(std::uint32_t triangle, int i) const { return vertices[triangles[triangle].vertices[std::size_t(i)]]; }

    /// Whether a contact normal (from this surface outward, unit) belongs to a triangle: beyond the part of the triangle
    /// that lies farthest that way, a corner or an edge, the surface must not go on any farther.
    bool owns_normal(const Triangle& triangle, const Vec3& normal) const;

    // Vertices joined to vertex v by an edge: ring[ring_start[v]] up to ring[ring_start[v + 1]].
    std::vector<std::uint32_t> ring_start, ring;
    // Triangles at vertex v, in the same way.
    std::vector<std::uint32_t> fan_start, fan;
};

/// Throws InputError when no triangle has an area.
CollisionMesh make_surface(const TriangleMesh& mesh, const Vec3& origin);

}  // namespace tumble
