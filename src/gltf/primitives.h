// Triangles of boxes, spheres and planes. Boxes and spheres have unit size: nodes scale them.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <vector>

namespace tumble {

struct Triangles {
    std::vector<float> positions, normals;  // three floats a vertex
    std::vector<std::uint32_t> indices;     // counter-clockwise seen from outside
};

Triangles unit_box();     // edges of 1
Triangles unit_sphere();  // radius 1
/// A square about a point, seen from the side of the unit normal.
Triangles square(const Vec3& center, const Vec3& normal, double half_side);

}  // namespace tumble
