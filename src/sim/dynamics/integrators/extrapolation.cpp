#include "sim/dynamics/integrators/extrapolation.h"

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

void extrapolation_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h) {
    using namespace extrapolation;
    constexpr std::array<double, columns> weight = weights(columns);
    const auto rate = [&](const StateVector& y) { return rate_of_change(y, mass, forces); };
    const StateVector y = vector_of(state);
    const StateVector first = rate(y);
    StateVector change = StateVector::Zero();
    for (std::size_t k = 0; k < columns; ++k) change += weight[k] * midpoint_change(y, first, h, counts[k], rate);
    state = state_of(StateVector(y + change));
}

}  // namespace tumble
