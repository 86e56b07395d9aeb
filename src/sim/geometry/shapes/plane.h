// Planes: the surface of an endless half-space, solid below, which cannot move freely.
#pragma once

#include "sim/geometry/shapes/interface.h"

namespace tumble {

struct HalfSpace {
    Vec3 normal;    // unit; solid below
    double offset;  // m

    static constexpr ContactSurface contact_surface = ContactSurface::plane;
    static constexpr bool can_move = false;
    Bounds world_bounds(const Pose&) const { return {Vec3::Constant(-infinity), Vec3::Constant(infinity)}; }
    double bounding_radius() const { return infinity; }
    double depth() const { return infinity; }
    double mean_projected_area() const { return 0.0; }
    RoundedHull rounded_hull() const { return {{&origin_point, 1}}; }
    std::uint32_t part_count() const { return 1; }
};

void visit_extent(const PlaneShape&, const ExtentVisitor&);
MassProperties mass_properties(const PlaneShape&, double density);
double first_hit(const PlaneShape& plane, const Vec3& from, const Vec3& direction);
PlaneShape enlarged(const PlaneShape& plane, double factor);
CollisionShape make_collider(const PlaneShape& plane, const ColliderRequest&, ColliderCache&);

}  // namespace tumble
