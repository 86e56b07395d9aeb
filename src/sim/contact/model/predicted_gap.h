// Predicted gap of points that approach on a curve. A contact row assumes that the gap closes at a constant speed along
// the normal, with the arms of the start of the step. With that alone a ball that rolls to a flush edge would collide
// with the edge ahead, and a corner of a rolling body would be stopped before it landed, at an arm at which it never
// touches, and throw the body up.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

namespace tumble {

/// Replacement of a manifold's point for the solvers: a uniform approach to this gap, with arms from the bodies'
/// positions at the start of the step to this position, ends where the bodies come nearest on their curves.
struct PredictedGap {
    Vec3 position = Vec3::Zero();  // world
    double gap = 0.0;              // m
    double slower = 0.0;           // m/s: decrease of the approach speed until then
};

/// The bodies of a manifold, with their velocities before the step's forces.
struct BodiesInStep {
    const Body &a, &b;
    const BodyVelocity &before_a, &before_b;
};

/// `h`: the time (s) in which the gap may be closed.
/// For a CurvedGap only the gap changes.
PredictedGap predicted_gap(const Manifold& manifold, int point, const BodiesInStep& bodies, double h);

/// A ball off its body's center of mass, as in a compound, moves on an arc. Over a step of h seconds this differs from
/// its velocity at the start of the step, w x r, times h. Returns the difference as a velocity (m/s) of B's ball
/// relative to A's face, or of A's relative to B's. Without it, a rolling body hops where its center of mass is low and
/// sinks where it is high.
Vec3 arc_velocity(const Manifold& manifold, const BodiesInStep& bodies, double h);

}  // namespace tumble
