// Impact laws for several contacts. Both laws keep momentum and symmetry, let contacts break away, never pull and never
// gain energy (Smith, Kaufman, Vouga, Tamstorf, Grinspun 2012, "Reflections on simultaneous impact"); for one contact
// both are eq. 20. They differ where contacts transmit an impulse:
//
// propagating: the approaching contacts are stopped by the least change d of the velocities and reflected, y += (1+e)
// d, repeatedly until nothing approaches (their section 4). A row of balls transmits the impulse to the last one.
//
// simultaneous: one change for all contacts together, the least one with v_rel+ >= -e v_rel- where a contact approached
// and v_rel+ >= 0 elsewhere (Newton's law as a complementarity problem). In a row of balls all those behind the first
// leave with one speed.
#pragma once

#include "scene/description/description.h"
#include "sim/impact/impact_system.h"

namespace tumble {

struct ImpactSettings {
    double threshold = 0.0;  // m/s: slower approaches do not bounce
    /// m/s: among more than tuning::pass_contacts contacts, slower approaches take no part in a pass of the propagating
    /// law and are left to the solver of resting contact. Half of the contacts of a heap at rest approach by trembling.
    double slow = 0.0;
    ImpactLaw law = ImpactLaw::propagating;
    /// m/s: contacts of nonballistic bodies with slower approaches count as at rest when the propagating law begins,
    /// whatever the sign of their trembling: the impulse reaches them from the contacts with impacts. Otherwise a
    /// single trembling ball of a bed would stop a plate for all the others.
    double resting = 0.0;
    bool friction = false;  // Coulomb friction within the impact
    /// Leaves nothing approaching: contacts that do not bounce are stopped (e = 0). Without it an impact in which
    /// nothing bounces is left to the solver of resting contact.
    bool complete = false;
    double span = 1.0;  // s: a joint's force in an impact is the mean over this time
};

/// m/s: the contact bounces if it approaches faster. The threshold of the impact, or of the contact's load if that is
/// larger.
double least_impact(const Contact& contact, double threshold);

/// True if any contact with restitution approaches fast enough to bounce.
bool bounces(const ImpactSystem& cluster, double threshold);

/// Repeats the law until nothing bounces; returns the number of passes. Jammed contacts (a ball between two walls)
/// would not end: they lose their restitution and stop. Threshold, slow and resting as in ImpactSettings.
int propagate(ImpactSystem& cluster, double threshold, double slow, double resting);
int resolve_together(ImpactSystem& cluster, double threshold);

/// The least change that leaves nothing approaching, e = 0. Returns false where there is none (between closing walls).
bool stop(ImpactSystem& cluster);

}  // namespace tumble
