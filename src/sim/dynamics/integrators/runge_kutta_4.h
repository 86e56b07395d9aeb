// The classical method of Runge and Kutta (Kutta 1901): four evaluations per step, error O(h^4). Neither symplectic nor
// reversible: energy drifts, by O(h^5) per step. The quaternion is normalized after each step.
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"

namespace tumble {

/// A step of h seconds.
void runge_kutta_4_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h);

/// The same for any vector of Eigen and any rate of change Vector(const Vector&).
template <class Vector, class Rate>
Vector runge_kutta_4(const Vector& y, double h, const Rate& rate) {
    const Vector k1 = rate(y);
    const Vector k2 = rate(Vector(y + 0.5 * h * k1));
    const Vector k3 = rate(Vector(y + 0.5 * h * k2));
    const Vector k4 = rate(Vector(y + h * k3));
    return y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
}

}  // namespace tumble
