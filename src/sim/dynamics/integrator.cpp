#include "sim/dynamics/integrator.h"

#include "sim/math/keyframe_track.h"

namespace tumble {

void advance_momenta(Body& body, const Vec3& force, const Vec3& torque, double h) {
    body.momentum += h * force;
    body.angular_momentum += h * torque;
}

void advance_momenta(Body& body, const Impulse& impulse) {
    body.momentum += impulse.linear;
    body.angular_momentum += impulse.angular;
    body.derive_velocities();
}

void advance_pose(Body& body, const Vec3& velocity, const Vec3& angular_velocity, double h, RotationForm form) {
    body.position += h * velocity;
    if (angular_velocity.isZero(0.0)) return;
    if (form == RotationForm::quaternion) {
        const Quat spin(0.0, angular_velocity.x(), angular_velocity.y(), angular_velocity.z());
        body.orientation.coeffs() += 0.5 * h * (spin * body.orientation).coeffs();
        body.orientation.normalize();
        body.rotation = body.orientation.toRotationMatrix();
    } else {
        Mat3 advanced = body.rotation;
        for (int i = 0; i < 3; ++i) advanced.col(i) += h * angular_velocity.cross(body.rotation.col(i));
        body.rotation = nearest_rotation(advanced);
        body.orientation = quaternion_of(body.rotation);
    }
}

void turn_exactly(Body& body, const Vec3& velocity, const Vec3& angular_velocity, double h) {
    body.position += h * velocity;
    if (angular_velocity.isZero(0.0)) return;
    body.orientation = (from_rotation_vector(h * angular_velocity) * body.orientation).normalized();
    body.rotation = body.orientation.toRotationMatrix();
}

Mat3 nearest_rotation(const Mat3& matrix) {
    Mat3 r = matrix;
    // Quadratic convergence: from the stretch sqrt(1 + (h omega)^2) of one step, usually 3 rounds, at most 10.
    for (int round = 0; round < 20; ++round) {
        const Mat3 next = 0.5 * (r + r.inverse().transpose());
        const double change = (next - r).cwiseAbs().maxCoeff();
        r = next;
        if (change < 1e-15) break;
    }
    return r;
}

Quat quaternion_of(const Mat3& m) {
    Quat q(m);
    q.normalize();
    return q;
}

}  // namespace tumble
