// A kinematic body goes where its keyframes say, whatever it meets: in each step it has the constant velocity that takes it from
// where they have it at the step's beginning to where they have it at its end. What rests on it or is struck by it feels that
// velocity; what explicit Euler moves by is the velocity the step begins with.
#pragma once

#include "sim/dynamics/body.h"

namespace tumble {

/// Puts the body, which has a track, where it is at `now` (s) and gives it the velocity that brings it to where it is at `next`,
/// h seconds later. Returns the velocity of its centre of mass that the step begins with.
BodyVelocity place_on_track(Body& body, double now, double next, double h);

/// The path's own velocity of the body's centre of mass at a moment (s), where the body stands at that moment.
BodyVelocity velocity_on_track(const Body& body, double time);

/// What a kinematic body has run into goes along with it for the rest of a step of h seconds, from `share` of it on, as if it were
/// fixed to it: where it was touched it is touched still when the next step resolves the collision.
void carry_along(Body& body, const Body& carrier, double share, double h);

}  // namespace tumble
