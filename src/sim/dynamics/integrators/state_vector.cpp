#include "sim/dynamics/integrators/state_vector.h"

namespace tumble {

StateVector vector_of(const RigidState& s) {
    StateVector y;
    y << s.position, s.orientation.coeffs(), s.momentum, s.angular_momentum;
    return y;
}

RigidState state_of(const StateVector& y) {
    return {y.head<3>(), Quat(y.segment<4>(3).normalized()), y.segment<3>(7), y.tail<3>()};
}

StateVector rate_of_change(const StateVector& y, const RigidMass& mass, const ForceLaw& forces) {
    const Quat q(y.segment<4>(3));
    const Mat3 rotation = rotation_of(q);
    const Vec3 velocity = mass.inverse_mass * y.segment<3>(7);
    const Vec3 omega = rotation * (mass.inverse_inertia * (rotation.transpose() * y.tail<3>()));
    const Wrench wrench = forces(velocity, rotation);
    StateVector rate;
    rate.head<3>() = velocity;
    rate.segment<4>(3) = 0.5 * (Quat(0.0, omega.x(), omega.y(), omega.z()) * q).coeffs();
    rate.segment<3>(7) = wrench.force;
    rate.tail<3>() = wrench.torque;
    return rate;
}

}  // namespace tumble
