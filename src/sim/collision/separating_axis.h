// Which features of two convex polyhedra face each other: the axis of least overlap (or of most separation) among the
// face normals of both and the cross products of their edges (Gottschalk 1996; Gregorius 2013, "The separating axis
// test between convex polyhedra").
#pragma once

#include "sim/collision/collide.h"

namespace tumble {

struct SeparatingAxis {
    enum class Kind { none, face_a, face_b, edges };   // none: farther apart than the margin
    Kind kind = Kind::none;
    double separation = 0.0;         // m along the axis; negative: overlap
    std::uint32_t feature_a = 0;     // face or edge of A
    std::uint32_t feature_b = 0;
    Vec3 normal = Vec3::Zero();      // away from A, in A's frame
};

/// `b_in_a` is B's pose in A's frame. Exact for all vertex counts: edges are left out of the search only where they
/// cannot take part in a contact.
SeparatingAxis find_separating_axis(const Polyhedron& a, const Polyhedron& b, const Pose& b_in_a, double margin,
                                    CollisionScratch& scratch);

/// How much better (m) an edge pair must separate than a face for being chosen, and B's face than A's: for shapes of this
/// size the choice then stays the same from step to step.
double axis_preference(double smaller_radius);

}  // namespace tumble
