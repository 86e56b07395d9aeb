#include "sim/dynamics/integrators/runge_kutta_4.h"

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

void runge_kutta_4_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h) {
    const auto rate = [&](const StateVector& y) { return rate_of_change(y, mass, forces); };
    const StateVector y = vector_of(state);
    const StateVector k1 = rate(y);
    const StateVector k2 = rate(y + 0.5 * h * k1);
    const StateVector k3 = rate(y + 0.5 * h * k2);
    const StateVector k4 = rate(y + h * k3);
    state = state_of(StateVector(y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)));
}

}  // namespace tumble
