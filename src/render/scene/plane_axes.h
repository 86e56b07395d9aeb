// The axes of a plane's pattern and of its tile in the AO atlas.
#pragma once

#include "core/vector.h"

#include <cmath>

namespace tumble {

struct PlaneAxes {
    Vec3 u, v;  // unit, in the plane, u x v = normal
};

inline PlaneAxes plane_axes(const Vec3& normal) {
    const Vec3 across = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 u = (across - normal * normal.dot(across)).normalized();
    return {u, normal.cross(u)};
}

}  // namespace tumble
