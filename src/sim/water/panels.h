// Triangles of a hull, divided until none is longer than a given edge, with a node at each corner and each middle of an
// edge: values at the six nodes of a triangle make a polynomial of the second degree on it.
#pragma once

#include "sim/water/hull_parts.h"

namespace tumble {

struct HullPanel {
    /// Corners, counterclockwise seen from outside, then the middles of the edges from corner 0 to 1, 1 to 2, 2 to 0.
    std::array<std::uint32_t, 6> nodes;
    Vec3 area;  // m^2, along the normal
};

struct Panels {
    HullPart part;            // without its vertices and triangles
    std::vector<Vec3> nodes;  // m
    std::vector<HullPanel> panels;
    double longest = 0.0;  // m, edge
};

/// Neighbors share the middles of their edges: the panels have no gaps. The edge (m) is longer where there would be
/// more than `most` panels.
Panels divided(HullPart part, double edge, std::size_t most);

}  // namespace tumble
