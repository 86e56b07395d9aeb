// Compounds: several convex shapes at fixed poses in one body. They do not collide with each other.
// Frame: the body's, with the center of mass of the whole at the origin.
#pragma once

#include "sim/geometry/shapes/curved.h"
#include "sim/geometry/shapes/hull.h"
#include "sim/geometry/shapes/mesh.h"
#include "sim/geometry/shapes/plane.h"
#include "sim/geometry/shapes/sphere.h"

#include <vector>

namespace tumble {

struct Compound {
    struct Part {
        CollisionShape collider;  // a ball, a polyhedron or a curved body, in the part's frame
        Pose place;               // pose of the part's frame in the body frame
        double reach = 0.0;       // m, distance of the part's farthest point from its own origin
    };

    std::vector<Part> parts;
    BoundsTree tree;      // over the bounds of the parts, body frame
    double radius = 0.0;  // m, distance of the farthest point from the center of mass
    // m, the least of the parts' inner radii: depth to which a shape may penetrate and still be pushed back out
    double inner_radius = 0.0;

    /// Derives the other fields from the parts' colliders and poses.
    void complete();

    static constexpr ContactSurface contact_surface = ContactSurface::parts;
    static constexpr bool can_move = true;
    Bounds world_bounds(const Pose& pose) const { return posed_bounds(tree.bounds(), pose); }
    double bounding_radius() const { return radius; }
    double depth() const { return inner_radius; }
    double mean_projected_area() const;
    RoundedHull rounded_hull() const { return {{&origin_point, 1}}; }
    std::uint32_t part_count() const { return std::uint32_t(parts.size()); }
};

/// World pose of a part, given the body's.
inline Pose part_pose(const Pose& body, const Compound::Part& part) {
    return {body.to_world(part.place.position), body.rotation * part.place.rotation};
}

void visit_extent(const CompoundShape& compound, const ExtentVisitor& visit);
MassProperties mass_properties(const CompoundShape& compound, double density);
double first_hit(const CompoundShape& compound, const Vec3& from, const Vec3& direction);
CollisionShape make_collider(const CompoundShape& compound, const ColliderRequest& request, ColliderCache& cache);

}  // namespace tumble
