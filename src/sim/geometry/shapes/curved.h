// Curved shapes: capsules, cylinders, cones and ellipsoids, with true circles. The first three are the convex hull of
// two discs about the y axis, rounded by a radius.
#pragma once

#include "sim/geometry/shapes/interface.h"

#include <algorithm>
#include <array>

namespace tumble {

struct CurvedBody {
    /// A disc normal to the y axis; a point without a radius.
    struct Disc {
        double y = 0.0, radius = 0.0;  // m
    };
    std::array<Disc, 2> discs;  // the lower one first
    double rounding = 0.0;      // m, added on all sides: the radius of a capsule
    bool ellipsoid = false;
    Vec3 radii = Vec3::Zero();                             // m, of an ellipsoid
    Vec3 slant = Vec3::UnitX();                            // of two discs: outward normal of the side at z = 0, x >= 0
    std::array<Vec3, 2> ends{Vec3::Zero(), Vec3::Zero()};  // m, centers of the discs
    double radius = 0.0;                                   // m, of the farthest point from the origin
    double inner_radius = 0.0;                             // m
    double projected_area = 0.0;                           // m^2, mean over all directions

    /// True for a shape with a flat end.
    bool has_disc(int end) const { return !ellipsoid && rounding == 0.0 && discs[std::size_t(end)].radius > 0.0; }
    /// Index of the disc that is farther along a direction.
    int end_along(const Vec3& direction) const;
    /// The farthest point along a direction (not zero), without the rounding.
    Vec3 support(const Vec3& direction) const;
    /// The point of a disc that is farthest along a direction.
    Vec3 rim_point(int end, const Vec3& direction) const;
    /// Distance of the farthest point along a unit direction from the origin, m.
    double extent(const Vec3& direction) const { return direction.dot(support(direction)) + rounding; }
    /// The derivative of the support point by the unit direction.
    Mat3 bend(const Vec3& direction) const;
    /// Distance of the farthest point from a given one, m; of an ellipsoid an upper bound.
    double farthest_from(const Vec3& point) const;

    static constexpr ContactSurface contact_surface = ContactSurface::round;
    static constexpr bool can_move = true;
    Bounds world_bounds(const Pose& pose) const;
    double bounding_radius() const { return radius; }
    double depth() const { return inner_radius; }
    double mean_projected_area() const { return projected_area; }
    /// Exact for capsules; for others see support().
    RoundedHull rounded_hull() const { return {ends, radius - rounding, rounding}; }
    /// That of the widest circle; the middle radius of an ellipsoid.
    double rolling_radius() const {
        if (ellipsoid) return radii.sum() - radii.maxCoeff() - radii.minCoeff();
        return std::max(discs[0].radius, discs[1].radius) + rounding;
    }
    std::uint32_t part_count() const { return 1; }
    bool contains(const Vec3& point, double tolerance) const;
};

void visit_extent(const CurvedShape& shape, const ExtentVisitor& visit);
MassProperties mass_properties(const CurvedShape& shape, double density);
double first_hit(const CurvedShape& shape, const Vec3& from, const Vec3& direction);
/// Outward normal (unit) of the surface at a point of it.
Vec3 normal_at(const CurvedShape& shape, const Vec3& point);
/// Without its triangles for drawing.
CurvedShape enlarged(const CurvedShape& shape, double factor);
CollisionShape make_collider(const CurvedShape& shape, const ColliderRequest& request, ColliderCache& cache);

}  // namespace tumble
