#include "sim/snapshot/snapshot_middle.h"

namespace tumble {
namespace {

/// The half of the shorter turn.
Quat middle_of(const Quat& a, const Quat& b) {
    if (a.coeffs() == b.coeffs()) return a;
    const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
    return Quat(Eigen::Vector4d(a.coeffs() + sign * b.coeffs())).normalized();
}

BodyState middle_of(const BodyState& a, const BodyState& b) {
    BodyState middle = b;
    middle.center_of_mass = 0.5 * (a.center_of_mass + b.center_of_mass);
    middle.orientation = middle_of(a.orientation, b.orientation);
    const Vec3 center = a.orientation.conjugate() * (a.center_of_mass - a.origin);  // body frame, from the origin
    middle.origin = middle.center_of_mass - middle.orientation * center;
    middle.velocity = 0.5 * (a.velocity + b.velocity);
    middle.angular_velocity = 0.5 * (a.angular_velocity + b.angular_velocity);
    middle.momentum = 0.5 * (a.momentum + b.momentum);
    middle.angular_momentum = 0.5 * (a.angular_momentum + b.angular_momentum);
    return middle;
}

}  // namespace

Snapshot middle_of(const Snapshot& a, const Snapshot& b) {
    Snapshot middle{a.frame, 0.5 * (a.time + b.time), {}};
    middle.bodies.reserve(a.bodies.size());
    for (std::size_t i = 0; i < a.bodies.size(); ++i) middle.bodies.push_back(middle_of(a.bodies[i], b.bodies[i]));
    return middle;
}

}  // namespace tumble
