// Curved shapes in code.
#pragma once

#include "scene/mesh/curved_mesh.h"

namespace tumble::testing {

inline CurvedShape drawn(CurvedShape shape) {
    shape.drawn = curved_mesh(shape);
    return shape;
}
inline CurvedShape capsule(double radius, double height) { return drawn({CurvedKind::capsule, radius, 0.0, height}); }
inline CurvedShape cylinder(double radius, double height) {
    return drawn({CurvedKind::cylinder, radius, radius, height});
}
inline CurvedShape cone(double radius, double height, double top_radius = 0.0) {
    return drawn({CurvedKind::cone, radius, top_radius, height});
}
inline CurvedShape ellipsoid(const Vec3& radii) { return drawn({CurvedKind::ellipsoid, 0.0, 0.0, 0.0, radii}); }

}  // namespace tumble::testing
