#include "sim/dynamics/integrators/runge_kutta_4.h"

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

void runge_kutta_4_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h) {
    const auto rate = [&](const StateVector& y) { return rate_of_change(y, mass, forces); };
    state = state_of(runge_kutta_4(vector_of(state), h, rate));
}

}  // namespace tumble
