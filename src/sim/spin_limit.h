// No turn adds energy to a body in contact. A step turns the pose by one tangent and keeps L: of a needle that can leave L along
// its thin axis, and the energy L.omega / 2 many times what it was; the next impact would make speed of that. What the turn
// has added is taken out of L.
#pragma once

#include "sim/body.h"

namespace tumble {

/// Twice the energy of its spin (J).
inline double spin(const Body& body) { return body.angular_momentum.dot(body.angular_velocity); }

/// Whether the spin has grown from what it was before the body turned, by more than tuning::spin_growth of it.
bool spin_grew(const Body& body, double before);

/// Scales L so that the spin is what it was.
void limit_spin(Body& body, double before);

}  // namespace tumble
