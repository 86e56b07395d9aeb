#include "sim/math/keyframe_track.h"

#include "core/deterministic_math.h"
#include "core/keyframe_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Below this angle (rad) the series to second order is exact to rounding.
constexpr double small_angle = 1e-4;

// Share of a segment, for the angular acceleration: its error of fourth order and its rounding are below 1e-12 of it.
constexpr double difference = 1e-3;

}  // namespace

// For q(u) = exp(phi(u)): the angular velocity in the rotating frame is J(phi) phi' with the right Jacobian
// J = I - (1 - cos t)/t^2 [phi] + (t - sin t)/t^3 [phi]^2, t = |phi| (Sola et al. 2018, "A micro Lie theory", eq. 143).
Vec3 body_spin(const Vec3& phi, const Vec3& rate) {
    const double t2 = phi.squaredNorm(), t = std::sqrt(t2);
    double a = 0.5 - t2 / 24.0, b = 1.0 / 6.0 - t2 / 120.0;
    if (t > small_angle) {
        const SinCos sc = sincos(t);
        a = (1.0 - sc.cos) / t2;
        b = (t - sc.sin) / (t2 * t);
    }
    const Vec3 once = phi.cross(rate);
    return rate - a * once + b * phi.cross(once);
}

// The inverse: J^-1 = I + 1/2 [phi] + (1/t^2 - (1 + cos t)/(2 t sin t)) [phi]^2 (Sola et al. 2018, eq. 144).
Vec3 rate_from_spin(const Vec3& phi, const Vec3& spin) {
    const double t2 = phi.squaredNorm(), t = std::sqrt(t2);
    double c = 1.0 / 12.0 + t2 / 720.0;
    if (t > small_angle) {
        const SinCos half = sincos(0.5 * t);  // (1 + cos t)/sin t = cot(t/2), finite at t = pi
        c = 1.0 / t2 - half.cos / (2.0 * t * half.sin);
    }
    const Vec3 once = phi.cross(spin);
    return spin + 0.5 * once + c * phi.cross(once);
}

Vec3 rotation_vector(const Quat& q) {
    const Quat p = q.w() < 0.0 ? Quat(-q.coeffs()) : q;
    const double s = p.vec().norm();
    if (s < 1e-15) return 2.0 * p.vec();
    return 2.0 * atan2_stable(s, p.w()) / s * p.vec();
}

Quat from_rotation_vector(const Vec3& v) {
    const double t2 = v.squaredNorm(), t = std::sqrt(t2);
    double w = 1.0 - t2 / 8.0, k = 0.5 - t2 / 48.0;
    if (t > small_angle) {
        const SinCos half = sincos(0.5 * t);
        w = half.cos;
        k = half.sin / t;
    }
    return Quat(w, k * v.x(), k * v.y(), k * v.z()).normalized();
}

KeyframeTrack::KeyframeTrack(std::vector<Keyframe> keys, Interpolation interpolation)
    : keys_(std::move(keys)), smooth_(interpolation == Interpolation::smooth) {
    const std::size_t n = keys_.size();
    velocity_.assign(n, Vec3::Zero());
    spin_.assign(n, Vec3::Zero());
    for (std::size_t i = 0; i + 1 < n; ++i)
        turn_.push_back(rotation_vector(keys_[i].rotation.conjugate() * keys_[i + 1].rotation));
    // At both ends the body is at rest, as it is outside of the keyframes.
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double before = keys_[i].time - keys_[i - 1].time, after = keys_[i + 1].time - keys_[i].time;
        velocity_[i] = smooth_slope<Vec3>((keys_[i].position - keys_[i - 1].position) / before,
                                          (keys_[i + 1].position - keys_[i].position) / after, before, after);
        // Rotating back along the last segment is -turn seen from its end: the same axis in both frames.
        spin_[i] = smooth_slope<Vec3>(turn_[i - 1] / before, turn_[i] / after, before, after);
    }
}

std::size_t KeyframeTrack::segment(double time) const {
    std::size_t i = 0;
    while (i + 2 < keys_.size() && keys_[i + 1].time <= time) ++i;
    return i;
}

KeyframeTrack::Motion KeyframeTrack::at(double time, double within) const {
    const Keyframe &first = keys_.front(), &last = keys_.back();
    if (within < first.time) return {first.position, first.rotation, Vec3::Zero(), Vec3::Zero()};
    if (within >= last.time) return {last.position, last.rotation, Vec3::Zero(), Vec3::Zero()};
    const std::size_t i = segment(within);
    return on(i, (time - keys_[i].time) / (keys_[i + 1].time - keys_[i].time));
}

KeyframeTrack::Motion KeyframeTrack::at(double time) const { return at(time, time); }

// `u`: share of the segment.
KeyframeTrack::Motion KeyframeTrack::on(std::size_t i, double u) const {
    const double span = keys_[i + 1].time - keys_[i].time;
    const Vec3 move = keys_[i + 1].position - keys_[i].position;
    if (!smooth_)
        return {keys_[i].position + u * move, keys_[i].rotation * from_rotation_vector(u * turn_[i]), move / span,
                keys_[i].rotation * Vec3(turn_[i] / span)};

    // Hermite basis and its derivative (by u).
    const double h1 = u * u * (3.0 - 2.0 * u), h2 = u * (1.0 - u) * (1.0 - u), h3 = -u * u * (1.0 - u);
    const double d1 = 6.0 * u * (1.0 - u), d2 = (1.0 - u) * (1.0 - 3.0 * u), d3 = u * (3.0 * u - 2.0);
    Motion m;
    const Vec3 va = span * velocity_[i], vb = span * velocity_[i + 1];
    m.position = keys_[i].position + h1 * move + h2 * va + h3 * vb;
    m.velocity = (d1 * move + d2 * va + d3 * vb) / span;
    const Vec3 ra = span * spin_[i], rb = rate_from_spin(turn_[i], span * spin_[i + 1]);
    const Vec3 phi = h1 * turn_[i] + h2 * ra + h3 * rb, rate = (d1 * turn_[i] + d2 * ra + d3 * rb) / span;
    m.rotation = keys_[i].rotation * from_rotation_vector(phi);
    m.angular_velocity = m.rotation * body_spin(phi, rate);
    return m;
}

// The second derivative of the position; that of the rotation by differences of the angular velocity, of fourth order.
KeyframeTrack::Acceleration KeyframeTrack::acceleration(double time, double within) const {
    if (!smooth_ || within < keys_.front().time || within >= keys_.back().time) return {};
    const std::size_t i = segment(within);
    const double span = keys_[i + 1].time - keys_[i].time, u = (time - keys_[i].time) / span;
    const Vec3 move = keys_[i + 1].position - keys_[i].position;
    const Vec3 va = span * velocity_[i], vb = span * velocity_[i + 1];
    const auto spin = [&](double ahead) { return on(i, u + ahead * difference).angular_velocity; };
    const Vec3 near = spin(1.0) - spin(-1.0), far = spin(2.0) - spin(-2.0);
    return {((6.0 - 12.0 * u) * move + (6.0 * u - 4.0) * va + (6.0 * u - 2.0) * vb) / (span * span),
            (8.0 * near - far) / (12.0 * difference * span)};
}

double KeyframeTrack::next_key(double time) const {
    const auto next = std::find_if(keys_.begin(), keys_.end(), [&](const Keyframe& key) { return key.time > time; });
    return next == keys_.end() ? std::numeric_limits<double>::infinity() : next->time;
}

}  // namespace tumble
