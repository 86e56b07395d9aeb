#include "page/motion_segment.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double least_contradiction = 1e-5, contradiction = 0.04;  // m; of the speed

/// Value and derivative by time.
struct Curve {
    Vec3 value, rate;
};

/// The quintic that is zero at both ends, with the given first and second derivatives there; `u` in 0..1 of `span` s.
Curve quintic(const Vec3& rate0, const Vec3& acceleration0, const Vec3& rate1, const Vec3& acceleration1, double u,
              double span) {
    const double v = 1.0 - u, u2 = u * u, v2 = v * v;
    const double a = u * v2 * v * (1.0 + 3.0 * u), b = -u2 * u * v * (1.0 + 3.0 * v);
    const double c = 0.5 * u2 * v2 * v, d = 0.5 * u2 * u * v2;
    const double a1 = v2 * (1.0 + 2.0 * u - 15.0 * u2), b1 = u2 * (1.0 + 2.0 * v - 15.0 * v2);
    const double c1 = 0.5 * u * v2 * (2.0 - 5.0 * u), d1 = 0.5 * u2 * v * (3.0 - 5.0 * u);
    return {span * (a * rate0 + b * rate1) + span * span * (c * acceleration0 + d * acceleration1),
            a1 * rate0 + b1 * rate1 + span * (c1 * acceleration0 + d1 * acceleration1)};
}

}  // namespace

Quat turn_by(const Vec3& turn) {
    const double angle = turn.norm();
    if (angle == 0.0) return Quat::Identity();
    const SinCos half = sincos(0.5 * angle);
    const Vec3 axis = half.sin / angle * turn;
    return {half.cos, axis.x(), axis.y(), axis.z()};
}

Vec3 turn_of(const Quat& rotation) {
    const double sine = rotation.vec().norm();
    if (sine == 0.0) return Vec3::Zero();
    const double sign = rotation.w() < 0.0 ? -1.0 : 1.0;
    return sign * 2.0 * atan2_stable(sine, sign * rotation.w()) / sine * rotation.vec();
}

double angle_between(const Quat& a, const Quat& b) {
    return 2.0 * std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

Vec3 free_angular_acceleration(const Mat3& inertia, const Quat& rotation, const Vec3& angular_velocity) {
    if (inertia.isZero(0.0)) return Vec3::Zero();
    const Vec3 w = rotation.conjugate() * angular_velocity;
    return rotation * Vec3(inertia.inverse() * (inertia * w).cross(w));
}

MotionSegment::MotionSegment(const Moment& start, const Moment& end, const Mat3& inertia) : start_(start), end_(end) {
    const double span = end.time - start.time;
    // Velocities that contradict the way: an impact or a landing at an unknown time in between.
    const Vec3 mean_velocity = (end.position - start.position) / span;
    const double off = (0.5 * (start.velocity + end.velocity) - mean_velocity).norm();
    const double fastest = std::max(start.velocity.norm(), end.velocity.norm());
    if (span * off > least_contradiction && off > contradiction * fastest)
        start_.velocity = end_.velocity = mean_velocity;
    turn_ = turn_of(end.rotation * start.rotation.conjugate());
    // Whole turns more, if the angular velocities say so.
    const Vec3 expected = 0.5 * span * (start.angular_velocity + end.angular_velocity);
    const double angle = turn_.norm();
    const Vec3 axis = angle > 1e-9 ? Vec3(turn_ / angle) : expected.isZero(0.0) ? Vec3::Zero() : expected.normalized();
    turn_ += 2.0 * pi * std::round((axis.dot(expected) - axis.dot(turn_)) / (2.0 * pi)) * axis;
    const Vec3 mean = turn_ / span;
    const Quat back = turn_by(-turn_);
    rate_start_ = start.angular_velocity - mean;
    rate_end_ = back * end.angular_velocity - mean;
    acceleration_start_ =
        free_angular_acceleration(inertia, start.rotation, start.angular_velocity) - mean.cross(rate_start_);
    acceleration_end_ =
        back * free_angular_acceleration(inertia, end.rotation, end.angular_velocity) - mean.cross(rate_end_);
}

Moment MotionSegment::at(double time) const {
    const double span = end_.time - start_.time, u = (time - start_.time) / span, v = 1.0 - u;
    Moment moment;
    moment.time = time;
    const Vec3 way = end_.position - start_.position;
    const Vec3 &v0 = start_.velocity, &v1 = end_.velocity;
    moment.position = start_.position + u * u * (3.0 - 2.0 * u) * way + span * u * v * (v * v0 - u * v1);
    moment.velocity = 6.0 * u * v / span * way + v * (1.0 - 3.0 * u) * v0 + u * (1.0 - 3.0 * v) * v1;
    const Curve small = quintic(rate_start_, acceleration_start_, rate_end_, acceleration_end_, u, span);
    const Quat uniform = turn_by(u * turn_);
    moment.rotation = (uniform * turn_by(small.value) * start_.rotation).normalized();
    const Vec3 bent = small.value.cross(small.rate);
    moment.angular_velocity = turn_ / span + uniform * Vec3(small.rate + 0.5 * bent + small.value.cross(bent) / 6.0);
    return moment;
}

}  // namespace tumble
