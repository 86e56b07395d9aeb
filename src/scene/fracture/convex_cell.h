// A convex polyhedron that half-spaces cut, with its faces. m; the body's frame.
#pragma once

#include "core/triangle_mesh.h"
#include "core/vector.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Keeps the points p with normal . p <= offset.
struct CutPlane {
    Vec3 normal;  // unit
    double offset;

    /// The other side. Two cells on both sides of a plane have exactly the same one.
    CutPlane flipped() const { return {-normal, -offset}; }
};

struct ConvexCell {
    struct Face {
        Vec3 normal;  // unit, outward
        double offset;
        std::vector<std::uint32_t> vertices;  // counterclockwise seen from outside
        bool outer;                           // of the body's own surface, not of a cut
    };

    std::vector<Vec3> vertices;
    std::vector<Face> faces;

    bool empty() const { return faces.empty(); }
    Bounds bounds() const;
    double volume() const;
    TriangleMesh mesh() const;
    /// Vertices within the tolerance (m) of the plane lie on it. Nothing is left if none is farther inside.
    void clip(CutPlane plane, double tolerance);
    /// Merges vertices that are nearer to each other than the tolerance (m).
    void weld(double tolerance);

private:
    bool try_clip(const CutPlane& plane, double tolerance);
    void drop_unused_vertices();
};

}  // namespace tumble
