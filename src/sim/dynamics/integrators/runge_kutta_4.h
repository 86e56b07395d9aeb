// The classical method of Runge and Kutta (Kutta 1901): four evaluations per step, error O(h^4). Neither symplectic nor
// reversible: energy drifts, by O(h^5) per step. The quaternion is normalized after each step.
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

/// A step of h seconds.
void runge_kutta_4_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h);

}  // namespace tumble
