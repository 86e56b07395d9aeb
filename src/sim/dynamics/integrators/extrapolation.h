// Extrapolation of the midpoint rule (Gragg 1965; Bulirsch and Stoer 1966; Hairer, Norsett, Wanner 1993, "Solving
// Ordinary Differential Equations I", section II.9): a step in 2, 4, 6, 8 and 10 parts, whose errors are series in h^2,
// and the polynomial through the five results at h = 0. Error O(h^10); 31 evaluations per step. An error of 1e-13 takes
// 120 evaluations per radian; order 8 takes 180, and order 12 hardly fewer than 120, with more rounding.
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

/// A step of h seconds. Without torque the angular momentum keeps every bit.
void extrapolation_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h);

}  // namespace tumble
