// Boxes about the origin of the body. They collide as polyhedra (hull.h).
#pragma once

#include "sim/geometry/shapes/hull.h"

namespace tumble {

/// A box of the given full edge lengths about the origin.
Polyhedron make_box(const Vec3& size);

/// Entry of a ray into a box about the origin, as a multiple of `direction`; 0 from inside, infinity without a hit.
double box_entry(const Vec3& half_size, const Vec3& from, const Vec3& direction);

void visit_extent(const BoxShape& box, const ExtentVisitor& visit);
/// I_x = m (y^2 + z^2) / 12 and cyclic.
MassProperties mass_properties(const BoxShape& box, double density);
double first_hit(const BoxShape& box, const Vec3& from, const Vec3& direction);
BoxShape enlarged(const BoxShape& box, double factor);
CollisionShape make_collider(const BoxShape& box, const ColliderRequest&, ColliderCache& cache);

}  // namespace tumble
