#include "sim/dynamics/integrators/splitting.h"

#include "core/deterministic_math.h"

namespace tumble {
namespace {

// P and L over h with x and q held, by the midpoint rule: forces that depend on the velocity keep the second order.
void kick(RigidState& s, const RigidMass& mass, const ForceLaw& forces, double h) {
    const Mat3 rotation = rotation_of(s.orientation);
    const auto at = [&](const Vec3& momentum, const Vec3& angular_momentum) {
        const Vec3 velocity = mass.inverse_mass * momentum;
        return forces({s.position, velocity, angular_momentum, rotation, s.elapsed});
    };
    const Wrench first = at(s.momentum, s.angular_momentum);
    const Wrench wrench = at(s.momentum + 0.5 * h * first.force, s.angular_momentum + 0.5 * h * first.torque);
    s.momentum += h * wrench.force;
    s.angular_momentum += h * wrench.torque;
}

// The term m_i^2 / 2 I_i of the kinetic energy alone: a rotation about the body's axis i at the constant rate
// m_i / I_i.
template <int i>
void turn(Quat& q, Vec3& m, const Vec3& inertia, double h) {
    constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto [s, c] = sincos(0.5 * h * m[i] / inertia[i]);
    // q times (c, s e_i).
    const double w = q.w(), qi = q.vec()[i], qj = q.vec()[j], qk = q.vec()[k];
    q.w() = c * w - s * qi;
    q.vec()[i] = c * qi + s * w;
    q.vec()[j] = c * qj + s * qk;
    q.vec()[k] = c * qk - s * qj;
    const double cosine = 1.0 - 2.0 * s * s, sine = 2.0 * s * c;
    const double mj = m[j], mk = m[k];
    m[j] = cosine * mj + sine * mk;
    m[k] = cosine * mk - sine * mj;
}

}  // namespace

void free_drift(RigidState& s, const RigidMass& mass, double h) {
    s.position += h * mass.inverse_mass * s.momentum;
    s.elapsed += h;
    if (s.angular_momentum.isZero(0.0)) return;
    Quat q = s.orientation * mass.principal_axes;
    Vec3 m = q.conjugate() * s.angular_momentum;  // in principal axes
    const Vec3& inertia = mass.principal_inertia;
    turn<0>(q, m, inertia, 0.5 * h);
    turn<1>(q, m, inertia, 0.5 * h);
    turn<2>(q, m, inertia, h);
    turn<1>(q, m, inertia, 0.5 * h);
    turn<0>(q, m, inertia, 0.5 * h);
    s.orientation = (q * mass.principal_axes.conjugate()).normalized();
}

void splitting_step(RigidState& state, const RigidMass& mass, const ForceLaw& forces, double h) {
    kick(state, mass, forces, 0.5 * h);
    free_drift(state, mass, h);
    kick(state, mass, forces, 0.5 * h);
}

}  // namespace tumble
