// Impacts: v_rel < 0 at touching points is reversed by impulses with restitution (notes eqs. 14 and 20), all contacts
// of an impact together, by the selected law (impact_laws.h), optionally with friction (impact_friction.h). Used where
// a step finds an impact, and at the impacts of the event-driven mode.
#pragma once

#include "sim/impact/impact_laws.h"

namespace tumble {

/// Resolves the impacts of one island's touching contacts at the bodies' velocities, which are changed in place (the
/// momenta are not: add_impact()); sets the impact, impact_friction and bounce_velocity of each contact that takes
/// part. Returns the number of passes; 0 without impacts.
/// `trace`: gets every impulse; its entries of a contact add up to the contact's. Null: not asked for.
/// `joint_impulses`: gets the impulses of the island's joints, which change no momenta either: apply_joint_impulse().
/// Null: not asked for. The joints have no strength: resolve_breaking().
int resolve_impacts(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                    const ImpactSettings& settings, ImpactTrace* trace = nullptr,
                    std::vector<JointImpulse>* joint_impulses = nullptr);

/// Instead of the number of passes: an island with joints whose impact takes too much work, and is left as it is.
inline constexpr int too_large = -1;

/// Restores after the step's forces the v_rel of points that bounced in the step, by the least change of motion: a ball
/// keeps its bounce speed through the step, from the floor or a ceiling, and with e = 1 retraces its path.
/// Acts against the forces alone: a body that it meets next is not pushed away. Bodies that an integrator of higher
/// order moved need no correction and get none.
/// Changes momenta and velocities. `threshold` as in ImpactSettings.
void hold_bounces(const Island& island, const std::vector<Contact>& contacts, std::vector<Body>& bodies,
                  double threshold);

}  // namespace tumble
