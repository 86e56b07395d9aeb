#include "sim/ccd/trajectory.h"

#include "core/deterministic_math.h"
#include "sim/dynamics/body.h"
#include "sim/math/keyframe_track.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double largest_turn = 2.0;      // rad: the bounds below hold up to here
constexpr double above_rounding = 1e-12;  // share by which the bounds exceed their values

}  // namespace

std::optional<CurvedRotation> CurvedRotation::between(const End& start, const End& end, double span) {
    CurvedRotation turn;
    turn.from = start.orientation;
    const Vec3 whole = rotation_vector(end.orientation * start.orientation.conjugate());
    const double fastest = std::max(start.angular_velocity.norm(), end.angular_velocity.norm());
    if (!(std::max(whole.norm(), span * fastest) < 0.5 * largest_turn)) return std::nullopt;
    const Vec3 mean = whole / span, last = rate_from_spin(-whole, end.angular_velocity);
    turn.rate = start.angular_velocity;
    turn.bend = (6.0 * mean - 4.0 * turn.rate - 2.0 * last) / span;
    turn.twist = (6.0 * (turn.rate + last) - 12.0 * mean) / (span * span);
    if (!(span * turn.spin_bound(span) < largest_turn)) return std::nullopt;
    return turn;
}

Quat CurvedRotation::orientation(double t) const { return (from_rotation_vector(vector(t)) * from).normalized(); }

Vec3 CurvedRotation::angular_velocity(double t) const {
    return body_spin(-vector(t), vector_rate(t));  // -theta: in the world
}

// |omega| <= |theta'|, since no singular value of the Jacobian exceeds 1. theta' is within the hull of its Bezier
// points.
double CurvedRotation::spin_bound(double span) const {
    const Vec3 middle = rate + 0.5 * span * bend;
    return std::max({rate.norm(), middle.norm(), vector_rate(span).norm()}) * (1.0 + above_rounding);
}

// |alpha| <= |theta''| + |J'| |theta'|, with |J'| <= (p / 6 + p^2 / 12 + p^3 / 60) |theta'| <= p / 2 |theta'| for
// p = |theta| <= 2.
double CurvedRotation::turning_bound(double span) const {
    const double spin = spin_bound(span), bending = std::max(bend.norm(), (bend + span * twist).norm());
    return (bending + spin * spin * (1.0 + 0.5 * span * spin)) * (1.0 + above_rounding);
}

namespace {

// Ratio of moments of inertia from which the ends of the polhode are computed; below, the simple bounds are within a
// factor of a few.
constexpr double bounded_by_ends = 3.0;

// The largest |m_i| of a torque-free body's momentum m in principal axes: the ends of the polhode, where the sphere
// |m| = G meets the ellipsoid sum m_i^2 / I_i = 2 T (van Zon and Schofield 2007). The axis that the momentum circles
// about is called 3, the middle one 2.
Vec3 momentum_ends(const Vec3& inertia, const Vec3& m) {
    int axis[3] = {0, 1, 2};
    std::sort(axis, axis + 3, [&](int l, int r) { return inertia[l] < inertia[r]; });
    const Vec3 s = m.cwiseAbs2();
    const auto i = [&](int k) { return inertia[axis[k]]; };
    // 2 T I_2 - G^2 without cancellation; positive: about the axis of the least moment.
    const double d = s[axis[0]] * (i(1) - i(0)) / i(0) - s[axis[2]] * (i(2) - i(1)) / i(2);
    if (d > 0.0) std::swap(axis[0], axis[2]);
    const double d31 = std::abs(i(2) - i(0)), d32 = std::abs(i(2) - i(1)), d21 = std::abs(i(1) - i(0));
    const double a = s[axis[0]] * d31 / i(0) + s[axis[1]] * d32 / i(1),
                 b = s[axis[1]] * d21 / i(1) + s[axis[2]] * d31 / i(2);
    const double square = m.squaredNorm();
    const auto end = [&](double value) {
        return std::sqrt(value < square ? value : square);
    };  // also where it is 0 / 0
    Vec3 ends;
    ends[axis[0]] = end(i(0) * a / d31);
    ends[axis[1]] = end(i(1) * a / d32);
    ends[axis[2]] = end(i(2) * b / d31);
    return ends;
}

}  // namespace

Trajectory Trajectory::flight(const Body& body, const Vec3& acceleration) {
    Trajectory path;
    path.start_ = body.position;
    path.velocity_ = body.velocity;
    path.acceleration_ = acceleration;
    path.turn_freely(body);
    return path;
}

Trajectory Trajectory::drift(const Body& body, const Vec3& velocity) {
    Trajectory path;
    path.start_ = body.position;
    path.velocity_ = velocity;
    path.turn_freely(body);
    return path;
}

void Trajectory::turn_freely(const Body& body) {
    if (body.angular_momentum.isZero(0.0)) {
        turn_uniformly(body.orientation, Vec3::Zero());
        return;
    }
    const Vec3& inertia = body.principal_inertia;
    turning_ = TorqueFreeRotation{FreeRotation(inertia, body.principal_axes, body.orientation, body.angular_momentum),
                                  body.inverse_inertia_body, body.angular_momentum};
    // With J = 1/I and m the momentum in body axes: |omega|^2 <= min(2 T Jmax, |L|^2 Jmax^2), and Euler's equations
    // alpha_i = J_i (J_k - J_j) m_j m_k with 2 |m_j m_k| <= |L|^2 give the bound of each component; the three cannot be
    // reached together, |alpha| <= 2/sqrt(3) of the largest.
    const Vec3 j = inertia.cwiseInverse();
    const double square = body.angular_momentum.squaredNorm();
    const double twice_energy = body.angular_momentum.dot(body.angular_velocity);
    const double most = j.maxCoeff();
    double spin_square = std::min(twice_energy * most, square * most * most);
    Vec3 component =
        0.5 * square * Vec3(j[0] * std::abs(j[2] - j[1]), j[1] * std::abs(j[0] - j[2]), j[2] * std::abs(j[1] - j[0]));
    if (inertia.maxCoeff() > bounded_by_ends * inertia.minCoeff()) {
        const Quat to_principal = (body.orientation * body.principal_axes).conjugate();
        const Vec3 ends = momentum_ends(inertia, to_principal * body.angular_momentum);
        spin_square = std::min(spin_square, ends.cwiseProduct(j).squaredNorm());
        const Vec3 products(ends[1] * ends[2], ends[2] * ends[0], ends[0] * ends[1]);
        component = component.cwiseMin(
            Vec3(j[0] * std::abs(j[2] - j[1]), j[1] * std::abs(j[0] - j[2]), j[2] * std::abs(j[1] - j[0]))
                .cwiseProduct(products));
    }
    const double angular = std::min(component.norm(), 1.1547005383792517 * component.maxCoeff());
    // Rounding must not bring the bounds below the true values.
    spin_bound_ = std::sqrt(spin_square) * (1.0 + 1e-12);
    turning_bound_ = (spin_square + angular) * (1.0 + 1e-12);
}

Trajectory Trajectory::uniform(const Body& body, const Vec3& velocity, const Vec3& angular_velocity) {
    Trajectory path;
    path.start_ = body.position;
    path.velocity_ = velocity;
    path.turn_uniformly(body.orientation, angular_velocity);
    return path;
}

Trajectory Trajectory::towards(const Body& body, const Motion& end, double span) {
    Trajectory path;
    path.move_along_cubic(body, end, span);
    path.turn_freely(body);
    return path;
}

Trajectory Trajectory::between(const Body& body, const Motion& end, double span) {
    Trajectory path;
    path.move_along_cubic(body, end, span);
    const auto turn = CurvedRotation::between({body.orientation, body.angular_velocity},
                                              {end.orientation, end.angular_velocity}, span);
    if (turn) {
        path.turning_ = *turn;
        path.spin_bound_ = turn->spin_bound(span);
        path.turning_bound_ = turn->turning_bound(span);
    } else {
        path.turn_uniformly(body.orientation, rotation_vector(end.orientation * body.orientation.conjugate()) / span);
    }
    return path;
}

void Trajectory::move_along_cubic(const Body& body, const Motion& end, double span) {
    start_ = body.position;
    velocity_ = body.velocity;
    const Vec3 mean_velocity = (end.position - body.position) / span;
    acceleration_ = (6.0 * mean_velocity - 4.0 * body.velocity - 2.0 * end.velocity) / span;
    jerk_ = (6.0 * (body.velocity + end.velocity) - 12.0 * mean_velocity) / (span * span);
}

void Trajectory::turn_uniformly(const Quat& from, const Vec3& angular_velocity) {
    UniformRotation uniform;
    uniform.from = from;
    uniform.rate = angular_velocity.norm();
    if (uniform.rate > 0.0) uniform.axis = angular_velocity / uniform.rate;
    spin_bound_ = uniform.rate;
    turning_bound_ = uniform.rate * uniform.rate;
    turning_ = uniform;
}

Trajectory Trajectory::deflected(double t, const Vec3& velocity) const {
    Trajectory path = *this;
    path.start_ = position(t);
    path.velocity_ = velocity;
    path.acceleration_ = acceleration(t);
    path.turned_ += t;
    return path;
}

Quat Trajectory::orientation(double t) const {
    t += turned_;
    if (const auto* free = std::get_if<TorqueFreeRotation>(&turning_)) return free->rotation.at(t);
    if (const auto* curved = std::get_if<CurvedRotation>(&turning_)) return curved->orientation(t);
    const auto& uniform = std::get<UniformRotation>(turning_);
    if (uniform.rate == 0.0) return uniform.from;
    const SinCos half = sincos(0.5 * uniform.rate * t);
    const Vec3 v = half.sin * uniform.axis;
    return Quat(half.cos, v.x(), v.y(), v.z()) * uniform.from;
}

// A curve deviates from its chord by at most max |x''| T^2 / 8, axis by axis; x'' is linear in time.
Bounds Trajectory::swept(double from, double to) const {
    Bounds bounds;
    bounds.add(position(from));
    bounds.add(position(to));
    const Vec3 most = acceleration(from).cwiseAbs().cwiseMax(acceleration(to).cwiseAbs());
    const Vec3 stray = (0.125 * (to - from) * (to - from)) * most;
    return {bounds.min - stray, bounds.max + stray};
}

Motion Trajectory::at(double t) const {
    Motion motion;
    motion.position = position(t);
    motion.velocity = velocity(t);
    motion.orientation = orientation(t);
    motion.rotation = motion.orientation.toRotationMatrix();
    if (const auto* free = std::get_if<TorqueFreeRotation>(&turning_)) {
        const Vec3 momentum = motion.rotation.transpose() * free->angular_momentum;
        motion.angular_velocity = motion.rotation * (free->inverse_inertia * momentum);
    } else if (const auto* curved = std::get_if<CurvedRotation>(&turning_)) {
        motion.angular_velocity = curved->angular_velocity(t + turned_);
    } else {
        const auto& uniform = std::get<UniformRotation>(turning_);
        motion.angular_velocity = uniform.rate * uniform.axis;
    }
    return motion;
}

}  // namespace tumble
