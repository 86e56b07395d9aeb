// Collisions: v_rel < 0 at touching points is turned round by impulses with restitution (notes eqs. 14 and 20), all
// contacts of a collision together, by the law chosen (impact_laws.h), with friction if asked for (impact_friction.h).
// Used where a step finds a collision, and at the moment of an impact between exact flights.
#pragma once

#include "sim/impact/impact_laws.h"

namespace tumble {

/// Resolves the collisions of one island's touching contacts at the bodies' velocities, which are changed in place (the
/// momenta are not: add_impact()); sets each taking part's impact, impact_friction and bounce_velocity.
/// Returns the number of passes; 0 when nothing collided.
int resolve_impacts(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                    const ImpactSettings& settings);

/// Gives the points that bounced in a step their v_rel back after the step's forces, by the least change of motion: a ball
/// keeps the speed it bounced with through the step, from the floor or a ceiling, and with e = 1 retraces its way. Against the forces alone: what meets
/// the body next is not pushed out of the way. What flew right to higher order, does so again: it retraces its fall without.
/// Changes momenta and velocities. `threshold` as in ImpactSettings.
void hold_bounces(const Island& island, const std::vector<Contact>& contacts, std::vector<Body>& bodies, double threshold);

}  // namespace tumble
