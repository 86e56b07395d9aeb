// A manifold tied to its two bodies: while they hardly move against each other, points, separations and normal follow
// from the poses and need no new search.
//
// The normal goes with the body whose face it belongs to, each point's two ends with their own bodies. The separation is
// then exact for faces, and right to second order in the motion for edges: only where on the surfaces the points lie goes
// out of date.
#pragma once

#include "sim/collision/collider.h"
#include "sim/collision/manifold.h"

#include <array>

namespace tumble {

struct Anchors {
    std::array<Vec3, Manifold::capacity> on_a, on_b;   // the points' ends on the surfaces, body frames
    Vec3 normal = Vec3::Zero();                        // in the frame of the body it belongs to
    bool normal_of_b = false;
};

/// `normal_of_b`: the normal is that of a face of B.
Anchors make_anchors(const Manifold& m, const Pose& pose_a, const Pose& pose_b, bool normal_of_b);

/// Normal, positions and separations of `m` for new poses.
void follow(const Anchors& anchors, const Pose& pose_a, const Pose& pose_b, Manifold& m);

}  // namespace tumble
