// Collisions: v_rel < 0 at touching points is turned round by impulses with restitution (notes eqs. 14 and 20), all
// contacts of a collision together.
//
// A pass takes the contacts that approach, finds the least change d of the velocities (in the metric of kinetic energy)
// that stops every approach, and applies it 1 + e times: a reflection of the velocities (Smith, Kaufman, Vouga, Tamstorf,
// Grinspun 2012, "Reflections on simultaneous impact", section 4). For one contact this is eq. 20. Passes follow until
// nothing approaches: a row of touching balls hands the impulse on from ball to ball, a box that lands flat gets no
// spin, and with e = 1 the kinetic energy stays what it was.
#pragma once

#include "sim/contact/islands.h"

namespace tumble {

/// Resolves the collisions of one island at the bodies' velocities; records each contact's impulse and v_rel afterwards.
/// Approaches slower than `threshold` (m/s) do not bounce; they are left to the resting contact solver.
/// Returns the number of passes; 0 when nothing collided.
int resolve_impacts(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies, double threshold);

}  // namespace tumble
