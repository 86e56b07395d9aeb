#include "sim/geometry/shapes/shape.h"

namespace tumble {

void visit_extent(const PlaneShape&, const ExtentVisitor&) {}

MassProperties mass_properties(const PlaneShape&, double) { return {}; }

double first_hit(const PlaneShape& plane, const Vec3& from, const Vec3& direction) {
    const double height = plane.normal.dot(from) - plane.offset, approach = -plane.normal.dot(direction);
    return height > 0.0 && approach > 0.0 ? height / approach : infinity;
}

PlaneShape enlarged(const PlaneShape& plane, double factor) { return {plane.normal, plane.offset * factor}; }

CollisionShape make_collider(const PlaneShape& plane, const ColliderRequest&, ColliderCache&) {
    return HalfSpace{plane.normal, plane.offset};
}

}  // namespace tumble
