// Spheres: solid balls about the origin of the body.
#pragma once

#include "core/deterministic_math.h"
#include "sim/geometry/shapes/interface.h"

namespace tumble {

struct Ball {
    double radius;  // m; the center is the body's origin

    static constexpr ContactSurface contact_surface = ContactSurface::curved;
    static constexpr bool can_move = true;
    Bounds world_bounds(const Pose& pose) const { return Bounds{pose.position, pose.position}.grown(radius); }
    double bounding_radius() const { return radius; }
    double rolling_radius() const { return radius; }
    double depth() const { return radius; }
    double mean_projected_area() const { return pi * radius * radius; }
    RoundedHull rounded_hull() const { return {{&origin_point, 1}, 0.0, radius}; }
    std::uint32_t part_count() const { return 1; }
    bool contains(const Vec3& point, double tolerance) const { return point.norm() <= radius + tolerance; }
};

void visit_extent(const SphereShape& ball, const ExtentVisitor& visit);
/// I = 2/5 m r^2.
MassProperties mass_properties(const SphereShape& ball, double density);
double first_hit(const SphereShape& ball, const Vec3& from, const Vec3& direction);
SphereShape enlarged(const SphereShape& ball, double factor);
CollisionShape make_collider(const SphereShape& ball, const ColliderRequest&, ColliderCache&);

}  // namespace tumble
