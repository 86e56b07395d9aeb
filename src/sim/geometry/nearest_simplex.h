// The point of a simplex nearest to the origin, for the search for the nearest points of two convex shapes (Gilbert,
// Johnson, Keerthi 1988).
#pragma once

#include "core/vector.h"

#include <array>

namespace tumble {

/// Up to four points of the Minkowski difference B - A whose hull contains the point nearest to the origin.
struct Simplex {
    std::array<Vec3, 4> points{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    int size = 0;
};

/// Keeps only the points that support the nearest point (Ericson 2005, "Real-Time Collision Detection", 5.1).
Vec3 nearest(Simplex& s);

}  // namespace tumble
