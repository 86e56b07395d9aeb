// The state as a point of R^13 and its rate of change: the interface of general methods for dy/dt = f(y).
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

using StateVector = Eigen::Matrix<double, 13, 1>;  // x, q (x, y, z, w), P, L

StateVector vector_of(const RigidState& state);
/// The state with its quaternion normalized.
RigidState state_of(const StateVector& y);

/// dx/dt = P/M, dq/dt = omega q / 2, dP/dt = F, dL/dt = tau (notes eq. 7 and section 3.1), omega = R I^-1 R^T L.
StateVector rate_of_change(const StateVector& y, const RigidMass& mass, const ForceLaw& forces);

}  // namespace tumble
