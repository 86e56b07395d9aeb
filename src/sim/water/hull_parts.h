// Triangles around the convex parts of a shape, by which water acts on it.
#pragma once

#include "sim/geometry/shapes/shape.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

struct HullPart {
    std::vector<Vec3> vertices;                           // m, the shape's frame
    std::vector<std::array<std::uint32_t, 3>> triangles;  // counterclockwise seen from outside
    double scale = 1.0;                                   // on areas: a curved surface is larger than its triangles
    double ball = 0.0;                                    // m, radius of a ball
    Vec3 center = Vec3::Zero();                           // m, of a ball or on the axis
    Vec3 axis = Vec3::Zero();                             // unit, of a surface of revolution; zero for others

    bool flat() const { return scale == 1.0; }  // curved surfaces are scaled
};

/// How triangles stand for a curved part: sides around its axis, and rings from its middle to an end.
struct Facets {
    int sides, rings;
    /// The triangles enclose the volume of the part, and balls have triangles. If false, corners are on the surface.
    bool by_volume;
};

/// Precondition: a shape that can move.
std::vector<HullPart> hull_parts(const CollisionShape& shape, const Facets& facets);

}  // namespace tumble
