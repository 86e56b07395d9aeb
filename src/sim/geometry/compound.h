// Several convex colliders that are one body. They keep their places in it and do not meet each other.
// Frame: the body's, with the whole's centre of mass at the origin.
#pragma once

#include "sim/geometry/bounds_tree.h"
#include "sim/geometry/collider.h"

#include <vector>

namespace tumble {

struct Compound {
    struct Part {
        CollisionShape collider;   // a ball or a polyhedron, in a frame of its own
        Pose place;          // of that frame, body frame
        double reach = 0.0;  // m, of its farthest point from its own origin
    };

    std::vector<Part> parts;
    BoundsTree tree;             // over the parts, body frame
    double radius = 0.0;         // m, of the farthest point from the centre of mass
    double inner_radius = 0.0;   // m, the least of the parts': how far something may come in and still be pushed back out

    /// Derives the rest from the parts' colliders and places.
    void complete();
};

/// The pose of a part, given the body's.
inline Pose part_pose(const Pose& body, const Compound::Part& part) {
    return {body.to_world(part.place.position), body.rotation * part.place.rotation};
}

}  // namespace tumble
