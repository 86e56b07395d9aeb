// Ends of cords in the world.
#pragma once

#include "scene/description/description.h"
#include "sim/snapshot/snapshot.h"

namespace tumble {

struct CordEnds {
    Vec3 anchor, point;  // world frame
};

inline Vec3 point_of_body(const BodyState& state, const Vec3& point) {
    return state.origin + state.orientation * point;
}

inline CordEnds cord_ends(const CordDescription& cord, const Snapshot& snapshot) {
    return {cord.anchor_body ? point_of_body(snapshot.bodies.at(*cord.anchor_body), cord.anchor) : cord.anchor,
            point_of_body(snapshot.bodies.at(cord.body), cord.point)};
}

}  // namespace tumble
