// What comes down along a curve. A point that does not touch is held from closing its gap within a time h at an even speed along the
// normal, with arms as they are when the step begins. A ball that rolls to a flush edge would run against the edge ahead of it, a
// corner of what rolls be stopped before it came down, at an arm at which it never touches, and throw the body up.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

namespace tumble {

/// A manifold's point as the solvers are to see it: an even approach to this gap, with arms from the bodies' places at the step's
/// start to this position, ends where the bodies come nearest on their curves.
struct PredictedGap {
    Vec3 position = Vec3::Zero();   // world
    double gap = 0.0;               // m
    double slower = 0.0;            // m/s: by how much the approach has slowed by then
};

/// `before`: the velocities before the step's forces; `h`: the time (s) in which the gap may be closed.
/// Of points on balls (OnBall::curve) the gap alone changes.
PredictedGap passing(const Manifold& manifold, int point, const Body& a, const Body& b, const BodyVelocity& before_a, const BodyVelocity& before_b,
                double h);

/// What carries a ball off its centre of mass, as a compound does, takes the ball's centre round an arc. Over a step of h seconds that is
/// another way than its velocity at the step's start, w x r, would take it: this is the difference, as a velocity of B's ball against
/// A's face (or A's against B's), m/s. Contact that leaves it out makes what rolls hop where its centre of mass is low, and sink where it is high.
Vec3 carried_round(const Manifold& manifold, const Body& a, const Body& b, const BodyVelocity& before_a, const BodyVelocity& before_b, double h);

}  // namespace tumble
