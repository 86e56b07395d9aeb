// A kinematic body follows its keyframes, whatever it meets: in each step it has the constant velocity that takes it
// from the keyframed pose at the start of the step to that at its end. Bodies in contact with it interact with that
// velocity; bodies that explicit Euler moves use the velocity at the start of the step.
#pragma once

#include "sim/dynamics/body.h"

namespace tumble {

/// Places the body, which has a track, at its pose of time `now` (s) and sets the velocity that brings it to that of
/// `next`, h seconds later. Returns the velocity of its center of mass at the start of the step.
BodyVelocity place_on_track(Body& body, double now, double next, double h);

/// The path's own velocity of the body's center of mass at a time (s). Precondition: the body has its pose of that
/// time.
BodyVelocity velocity_on_track(const Body& body, double time);

/// Moves a body that a kinematic body has run into along with the carrier for the rest of a step of h seconds, from
/// `share` of it on, as if fixed to it: the contact still touches when the next step resolves the impact.
void carry_along(Body& body, const Body& carrier, double share, double h);

}  // namespace tumble
