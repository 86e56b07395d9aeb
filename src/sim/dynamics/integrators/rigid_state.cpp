#include "sim/dynamics/integrators/rigid_state.h"

#include "sim/dynamics/body.h"
#include "sim/math/keyframe_track.h"

namespace tumble {

RigidState state_of(const Body& body) {
    return {body.position, body.orientation, body.momentum, body.angular_momentum};
}

RigidMass mass_of(const Body& body) {
    return {body.inverse_mass, body.inverse_inertia_body, body.principal_inertia, body.principal_axes};
}

void set_state(Body& body, const RigidState& state) {
    body.position = state.position;
    body.orientation = state.orientation;
    body.rotation = state.orientation.toRotationMatrix();
    body.momentum = state.momentum;
    body.angular_momentum = state.angular_momentum;
    body.derive();
}

BodyVelocity mean_velocity(const Body& start, const RigidState& end, double h) {
    return {(end.position - start.position) / h, rotation_vector(end.orientation * start.orientation.conjugate()) / h};
}

Mat3 rotation_of(const Quat& q) {
    const double s = 2.0 / q.squaredNorm();
    const Vec3 v = q.vec(), u = s * v, w = s * q.w() * v;
    Mat3 r;
    r << 1.0 - u.y() * v.y() - u.z() * v.z(), u.x() * v.y() - w.z(), u.x() * v.z() + w.y(),  //
        u.x() * v.y() + w.z(), 1.0 - u.x() * v.x() - u.z() * v.z(), u.y() * v.z() - w.x(),   //
        u.x() * v.z() - w.y(), u.y() * v.z() + w.x(), 1.0 - u.x() * v.x() - u.y() * v.y();
    return r;
}

StateVector vector_of(const RigidState& s) {
    StateVector y;
    y << s.position, s.orientation.coeffs(), s.momentum, s.angular_momentum, s.elapsed;
    return y;
}

RigidState state_of(const StateVector& y) {
    return {y.head<3>(), Quat(y.segment<4>(3).normalized()), y.segment<3>(7), y.segment<3>(10), y[13]};
}

StateVector rate_of_change(const StateVector& y, const RigidMass& mass, const ForceLaw& forces) {
    const Quat q(y.segment<4>(3));
    const Mat3 rotation = rotation_of(q);
    const Vec3 velocity = mass.inverse_mass * y.segment<3>(7);
    const Vec3 position = y.head<3>(), angular_momentum = y.segment<3>(10);
    const Vec3 omega = rotation * (mass.inverse_inertia * (rotation.transpose() * angular_momentum));
    const Wrench wrench = forces({position, velocity, angular_momentum, rotation, y[13]});
    StateVector rate;
    rate.head<3>() = velocity;
    rate.segment<4>(3) = 0.5 * (Quat(0.0, omega.x(), omega.y(), omega.z()) * q).coeffs();
    rate.segment<3>(7) = wrench.force;
    rate.segment<3>(10) = wrench.torque;
    rate[13] = 1.0;
    return rate;
}

}  // namespace tumble
