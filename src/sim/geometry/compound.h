// Several convex shapes at fixed poses in one body. They do not collide with each other.
// Frame: the body's, with the center of mass of the whole at the origin.
#pragma once

#include "sim/geometry/bounds_tree.h"
#include "sim/geometry/collider.h"

#include <vector>

namespace tumble {

struct Compound {
    struct Part {
        CollisionShape collider;  // a ball or a polyhedron, in the part's frame
        Pose place;               // pose of the part's frame in the body frame
        double reach = 0.0;       // m, distance of the part's farthest point from its own origin
    };

    std::vector<Part> parts;
    BoundsTree tree;      // over the bounds of the parts, body frame
    double radius = 0.0;  // m, distance of the farthest point from the center of mass
    // m, the least of the parts' inner radii: depth to which a shape may penetrate and still be pushed back out
    double inner_radius = 0.0;

    /// Derives the other fields from the parts' colliders and places.
    void complete();
};

/// World pose of a part, given the body's.
inline Pose part_pose(const Pose& body, const Compound::Part& part) {
    return {body.to_world(part.place.position), body.rotation * part.place.rotation};
}

}  // namespace tumble
