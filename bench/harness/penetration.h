// Depth of overlaps, by the benchmark's own separating axes: the same measure for every program.
#pragma once

#include "harness/scene.h"

#include <vector>

namespace tumble::bench {

struct Penetration {
    long pairs = 0;        // nearer than `near`
    double mean = 0.0;     // m, of max(0, depth) over those pairs
    double largest = 0.0;  // m
    double squares = 0.0;  // m^2, sum of squared depths
};

/// Over all pairs with at least one moving body. Bodies that are not finite are excluded.
Penetration penetration(const Scene& scene, const std::vector<Motion>& motions, double near = 0.01);

/// The least overlap over all separating axes, m; below -near only its sign is meaningful. Spheres meet planes, boxes
/// and each other; hexahedra meet planes, boxes and each other.
double depth(const Body& a, const Motion& at, const Body& b, const Motion& bt, double near = 0.01);

bool finite(const Motion& motion);

}  // namespace tumble::bench
