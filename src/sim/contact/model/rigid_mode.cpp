#include "sim/contact/model/rigid_mode.h"

namespace tumble {
namespace {

// Inertia of a point mass at r: m (r.r - r r^T).
Mat3 point_inertia(double mass, const Vec3& r) {
    return mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
}

Mat3 inertia_of(const Body& body) { return body.rotation * body.inertia_body * body.rotation.transpose(); }

}  // namespace

void RigidMode::add(const Body& body, const Vec3& origin) {
    const Vec3 r = body.position - origin;
    mass_ += body.mass;
    moment_ += body.mass * r;
    momentum_ += body.momentum;
    angular_momentum_ += body.angular_momentum + r.cross(body.momentum);
    inertia_ += inertia_of(body) + point_inertia(body.mass, r);
}

void RigidMode::add(const RigidMode& other) {
    mass_ += other.mass_;
    moment_ += other.moment_;
    momentum_ += other.momentum_;
    angular_momentum_ += other.angular_momentum_;
    inertia_ += other.inertia_;
}

void RigidMode::finish() {
    center_ = moment_ / mass_;
    velocity_ = momentum_ / mass_;
    inertia_ -= point_inertia(mass_, center_);  // Steiner's theorem
    angular_momentum_ -= center_.cross(momentum_);
    angular_velocity_ = inertia_.inverse() * angular_momentum_;
}

double RigidMode::energy() const { return 0.5 * (momentum_.dot(velocity_) + angular_momentum_.dot(angular_velocity_)); }

BodyVelocity RigidMode::at(const Vec3& position, const Vec3& origin) const {
    return {velocity_ + angular_velocity_.cross(position - origin - center_), angular_velocity_};
}

void RigidMode::scale_rest(double scale, const Vec3& origin, Body& body) const {
    const BodyVelocity common = at(body.position, origin);
    const Vec3 linear = body.velocity + body.correction_velocity,
               angular = body.angular_velocity + body.correction_angular_velocity;
    const Vec3 common_spin = inertia_of(body) * common.angular_velocity;
    body.momentum = body.mass * common.velocity + scale * (body.momentum - body.mass * common.velocity);
    body.angular_momentum = common_spin + scale * (body.angular_momentum - common_spin);
    body.derive_velocities();
    body.correction_velocity = linear - body.velocity;
    body.correction_angular_velocity = angular - body.angular_velocity;
}

void keep_angular_momentum(std::span<const std::uint32_t> island, std::vector<Body>& bodies, double h,
                           const Vec3& carried) {
    const Vec3 origin = bodies[island[0]].position;
    Vec3 gained = carried, center = Vec3::Zero();
    double mass = 0.0;
    for (const std::uint32_t i : island) {
        const Body& body = bodies[i];
        gained += h * body.correction_velocity.cross(body.momentum);
        center += body.mass * (body.position - origin);
        mass += body.mass;
    }
    if (gained.isZero(0.0)) return;
    center = origin + center / mass;
    Mat3 inertia = Mat3::Zero();
    for (const std::uint32_t i : island) {
        const Body& body = bodies[i];
        const Vec3 r = body.position - center, pushed = r + h * body.correction_velocity;
        inertia += inertia_of(body) + body.mass * (pushed.dot(r) * Mat3::Identity() - r * pushed.transpose());
    }
    const Vec3 faster = inertia.inverse() * -gained;
    for (const std::uint32_t i : island) {
        Body& body = bodies[i];
        body.momentum += body.mass * faster.cross(body.position - center);
        body.angular_momentum += inertia_of(body) * faster;
        body.derive_velocities();
    }
}

}  // namespace tumble
