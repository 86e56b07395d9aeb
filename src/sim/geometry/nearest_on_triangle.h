#pragma once

#include "core/vector.h"

namespace tumble {

struct NearestOnTriangle {
    Vec3 point;
    int feature;  // 0 face, 1 to 3 edge, 4 to 6 vertex
};

/// Nearest point of a triangle with its feature (Ericson 2005, "Real-Time Collision Detection", 5.1.5).
NearestOnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tumble
