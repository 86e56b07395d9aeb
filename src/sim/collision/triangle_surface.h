// A fixed triangle mesh that collides as it is. Each triangle knows its neighbours' normals, so that a body sliding
// over a seam between two triangles is not caught by it.
#pragma once

#include "core/triangle_mesh.h"
#include "core/vector.h"
#include "sim/collision/bounds_tree.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

struct TriangleSurface {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices{};
        Vec3 normal = Vec3::Zero();                       // unit, by the winding
        std::array<Vec3, 3> outward{};                    // unit, in the plane, out over edge i (from vertex i to i + 1)
        std::array<std::int32_t, 3> neighbour{-1, -1, -1};   // triangle over edge i; -1: open or crowded
        std::array<std::uint32_t, 3> edge{};              // index of edge i, shared with the neighbour
    };

    std::vector<Vec3> vertices;
    std::vector<Triangle> triangles;
    std::uint32_t edge_count = 0;
    BoundsTree tree;                                // over the triangles, body frame
    double radius = 0.0;                            // m, about the body's centre
    bool closed = false;                            // solid inside: only the outer side pushes. Open: both sides do

    Vec3 corner(std::uint32_t triangle, int i) const { return vertices[triangles[triangle].vertices[std::size_t(i)]]; }

    /// Whether a contact normal (from this surface outward, unit) belongs to a triangle: it may lean over an edge only as
    /// far as a convex neighbour's normal. `side` is -1 when the back of an open surface is touched, else +1.
    bool owns_normal(const Triangle& triangle, const Vec3& normal, double side) const;
};

/// Throws InputError when no triangle has an area.
TriangleSurface make_surface(const TriangleMesh& mesh, const Vec3& origin);

}  // namespace tumble
