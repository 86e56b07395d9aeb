// Resting contact and friction, over one island: the notes leave it out (section 4); without it bodies jitter and sink.
//
// Velocity level: for each contact an impulse j >= 0 such that the points do not come nearer than they are apart by the
// end of the step (v_rel >= -separation/h), and a friction impulse across the normal inside Coulomb's disc |f| <= mu j.
// Projected Gauss-Seidel from last step's impulses (Catto 2005, "Iterative dynamics with temporal coherence"), until a
// sweep changes next to nothing. Overlaps are pushed out by velocities of their own that move the poses once and leave
// the momenta alone (split impulses; Guendelman, Bridson, Fedkiw 2003), so that correcting a position heats nothing up.
#pragma once

#include "sim/contact/islands.h"

namespace tumble {

struct RestSettings {
    double h;                   // step, s
    double bounce_threshold;    // m/s: faster approaches with restitution are left to overlap and collide
    double tolerance;           // m/s: a sweep that changes less ends the solve
};

/// Solves for the velocities after the step's forces; sets impulses and push velocities. The same order, and so the same
/// bytes, on any thread.
void solve_rest(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                const RestSettings& settings);

}  // namespace tumble
