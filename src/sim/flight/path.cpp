#include "sim/flight/path.h"

#include "core/elementary.h"
#include "sim/body.h"
#include "sim/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {

Path Path::flight(const Body& body, const Vec3& acceleration) {
    Path path;
    path.start_ = body.position;
    path.velocity_ = body.velocity;
    path.acceleration_ = acceleration;
    path.turn_freely(body);
    return path;
}

void Path::turn_freely(const Body& body) {
    if (body.angular_momentum.isZero(0.0)) {
        turn_uniformly(body.orientation, Vec3::Zero());
        return;
    }
    const Vec3& inertia = body.principal_inertia;
    turning_ = FreeTurn{FreeRotation(inertia, body.principal_axes, body.orientation, body.angular_momentum),
                         body.inverse_inertia_body, body.angular_momentum};
    // With J = 1/I and m the momentum in body axes: |omega|^2 <= min(2 T Jmax, |L|^2 Jmax^2), and Euler's equations
    // alpha_i = J_i (J_k - J_j) m_j m_k with 2 |m_j m_k| <= |L|^2 give the bound of each component; the three cannot be
    // reached together, |alpha| <= 2/sqrt(3) of the largest.
    const Vec3 j = inertia.cwiseInverse();
    const double square = body.angular_momentum.squaredNorm();
    const double twice_energy = body.angular_momentum.dot(body.angular_velocity);
    const double most = j.maxCoeff();
    const double spin_square = std::min(twice_energy * most, square * most * most);
    const Vec3 component = 0.5 * square * Vec3(j[0] * std::abs(j[2] - j[1]), j[1] * std::abs(j[0] - j[2]), j[2] * std::abs(j[1] - j[0]));
    const double angular = std::min(component.norm(), 1.1547005383792517 * component.maxCoeff());
    // Rounding must not take the bounds below the truth.
    spin_bound_ = std::sqrt(spin_square) * (1.0 + 1e-12);
    turning_bound_ = (spin_square + angular) * (1.0 + 1e-12);
}

Path Path::uniform(const Body& body, const Vec3& velocity, const Vec3& angular_velocity) {
    Path path;
    path.start_ = body.position;
    path.velocity_ = velocity;
    path.turn_uniformly(body.orientation, angular_velocity);
    return path;
}

Path Path::towards(const Body& body, const Motion& end, double span, bool torque_free) {
    Path path;
    path.start_ = body.position;
    path.velocity_ = body.velocity;
    const Vec3 way = (end.position - body.position) / span;
    path.acceleration_ = (6.0 * way - 4.0 * body.velocity - 2.0 * end.velocity) / span;
    path.jerk_ = (6.0 * (body.velocity + end.velocity) - 12.0 * way) / (span * span);
    if (torque_free) path.turn_freely(body);
    else path.turn_uniformly(body.orientation, rotation_vector(end.orientation * body.orientation.conjugate()) / span);
    return path;
}

void Path::turn_uniformly(const Quat& from, const Vec3& angular_velocity) {
    UniformTurn uniform;
    uniform.from = from;
    uniform.rate = angular_velocity.norm();
    if (uniform.rate > 0.0) uniform.axis = angular_velocity / uniform.rate;
    spin_bound_ = uniform.rate;
    turning_bound_ = uniform.rate * uniform.rate;
    turning_ = uniform;
}

Path Path::deflected(double t, const Vec3& velocity) const {
    Path path = *this;
    path.start_ = position(t);
    path.velocity_ = velocity;
    path.acceleration_ = acceleration(t);
    path.turned_ += t;
    return path;
}

Quat Path::orientation(double t) const {
    t += turned_;
    if (const auto* free = std::get_if<FreeTurn>(&turning_)) return free->rotation.at(t);
    const auto& uniform = std::get<UniformTurn>(turning_);
    if (uniform.rate == 0.0) return uniform.from;
    const SinCos half = sincos(0.5 * uniform.rate * t);
    const Vec3 v = half.sin * uniform.axis;
    return Quat(half.cos, v.x(), v.y(), v.z()) * uniform.from;
}

// A curve strays from its chord by at most max |x''| T^2 / 8, axis by axis; x'' is linear in time.
Bounds Path::swept(double from, double to) const {
    Bounds bounds;
    bounds.add(position(from));
    bounds.add(position(to));
    const Vec3 most = acceleration(from).cwiseAbs().cwiseMax(acceleration(to).cwiseAbs());
    const Vec3 stray = (0.125 * (to - from) * (to - from)) * most;
    return {bounds.min - stray, bounds.max + stray};
}

Motion Path::at(double t) const {
    Motion motion;
    motion.position = position(t);
    motion.velocity = velocity(t);
    motion.orientation = orientation(t);
    motion.rotation = motion.orientation.toRotationMatrix();
    if (const auto* free = std::get_if<FreeTurn>(&turning_)) {
        const Vec3 momentum = motion.rotation.transpose() * free->angular_momentum;
        motion.angular_velocity = motion.rotation * (free->inverse_inertia * momentum);
    } else {
        const auto& uniform = std::get<UniformTurn>(turning_);
        motion.angular_velocity = uniform.rate * uniform.axis;
    }
    return motion;
}

}  // namespace tumble
