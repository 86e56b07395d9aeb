// What an impact with several contacts does. Both laws keep momentum and symmetry, let contacts break away, never pull
// and never gain energy (Smith, Kaufman, Vouga, Tamstorf, Grinspun 2012, "Reflections on simultaneous impact"); for one
// contact both are eq. 20. They differ where contacts hand an impulse on:
//
// propagating: the contacts that approach are stopped by the least change d of the velocities and reflected, y += (1+e) d,
// again and again until nothing approaches (their section 4). A row of balls passes the blow on to the last one.
//
// simultaneous: one change for all contacts together, the least one with v_rel+ >= -e v_rel- where a contact approached
// and v_rel+ >= 0 elsewhere (Newton's law as a complementarity problem). In a row of balls all those behind the first
// leave with one speed.
#pragma once

#include "scene/description/description.h"
#include "sim/impact/impact_system.h"

namespace tumble {

struct ImpactSettings {
    double threshold = 0.0;   // m/s: slower approaches do not bounce
    /// m/s: among more than tuning::pass_contacts, contacts that approach slower take no part in a pass of the propagating law
    /// and are left to the solver of resting contact. A heap at rest trembles in half of its contacts.
    double slow = 0.0;
    ImpactLaw law = ImpactLaw::propagating;
    /// m/s: contacts of bodies that do not fly and approach slower than this are at rest when the propagating law begins, whichever
    /// way they tremble: the blow comes to them from those that do strike. Taken in by that trace, one ball of a bed stops a plate
    /// for all the others.
    double resting = 0.0;
    bool friction = false;    // Coulomb friction in the impact itself
    /// Nothing is left approaching: what does not bounce is stopped (e = 0). Without it an impact in which nothing bounces
    /// is left to the solver of resting contact.
    bool complete = false;
};

/// Whether any contact approaches fast enough, and has the restitution, to bounce.
bool bounces(const ImpactSystem& cluster, double threshold);

/// Repeats the law until nothing bounces; returns the passes. Jammed contacts (a ball between two walls) have no end: they
/// lose their restitution and stop. Threshold, slow and resting as in ImpactSettings.
int propagate(ImpactSystem& cluster, double threshold, double slow, double resting);
int resolve_together(ImpactSystem& cluster, double threshold);

/// The least change that leaves nothing approaching, e = 0. False where there is none (between closing walls).
bool stop(ImpactSystem& cluster);

}  // namespace tumble
