// Splitting of second order (Strang 1968; Verlet 1967): half a kick by the forces, a drift without them, half a kick.
// The drift's rotation is split once more, into five rotations about the principal axes, each of them exact (Dullweber,
// Leimkuhler, McLachlan 1997, "Symplectic splitting methods for rigid body molecular dynamics", J. Chem. Phys. 107).
//
// Symplectic and time-reversible: the energy error stays bounded, and a motion run back ends where it began. Without
// torque L keeps every bit. Error O(h^2); forces are evaluated twice at either end of a step, because of drag.
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

/// The drift alone: h seconds of free flight.
void free_drift(RigidState& state, const RigidMass& mass, double h);

/// A step of h seconds.
void splitting_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h);

}  // namespace tumble
