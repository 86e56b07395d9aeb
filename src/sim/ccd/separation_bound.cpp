#include "sim/ccd/separation_bound.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// First root s >= 0 of f + r s - q s^2 / 2 for f >= 0, q >= 0, without cancellation.
double first_root(double f, double r, double q) {
    const double root = std::sqrt(r * r + 2.0 * q * f);
    if (r > 0.0) return q > 0.0 ? (r + root) / q : infinity;
    if (root - r > 0.0) return 2.0 * f / (root - r);
    return q > 0.0 ? 0.0 : infinity;  // f = r = 0: it falls at once, if at all
}

// A point's height along the axis and its rate of change.
struct Height {
    double value, rate;
    double at(double s) const { return value + s * rate; }
};

Height height(const SupportPoints& cloud, std::size_t i, const Axis& axis) {
    return {axis.normal.dot(cloud.arms[i]), axis.rate.dot(cloud.arms[i]) + axis.normal.dot(cloud.arm_velocity(i))};
}

// The lowest of B's points and the highest of A's at time s, as one line; at equal heights the faster closing one.
Height lowest_line(const SupportPoints& a, const SupportPoints& b, const Axis& axis, const Height& centers, double s) {
    Height low{infinity, 0.0}, high{-infinity, 0.0};
    for (std::size_t i = 0; i < b.arms.size(); ++i) {
        const Height h = height(b, i, axis);
        if (h.at(s) < low.at(s) || (h.at(s) == low.at(s) && h.rate < low.rate)) low = h;
    }
    for (std::size_t i = 0; i < a.arms.size(); ++i) {
        const Height h = height(a, i, axis);
        if (h.at(s) > high.at(s) || (h.at(s) == high.at(s) && h.rate > high.rate)) high = h;
    }
    return {centers.value + low.value - high.value, centers.rate + low.rate - high.rate};
}

}  // namespace

SeparationBound bound_separation(const SupportPoints& a, const SupportPoints& b, const Axis& axis, double horizon,
                                 double nearest) {
    const Vec3 d = b.center - a.center, v = b.velocity - a.velocity, acceleration = b.acceleration - a.acceleration;
    const Height centers{axis.normal.dot(d) - a.radius - b.radius, axis.rate.dot(d) + axis.normal.dot(v)};
    const Height line = lowest_line(a, b, axis, centers, 0.0);

    SeparationBound bound;
    bound.gap = line.value;
    bound.rate = line.rate;
    if (nearest > 0.0) {
        double low = infinity, high = -infinity, low_rate = infinity, high_rate = -infinity;
        for (std::size_t i = 0; i < b.arms.size(); ++i) low = std::min(low, axis.normal.dot(b.arms[i]));
        for (std::size_t i = 0; i < a.arms.size(); ++i) high = std::max(high, axis.normal.dot(a.arms[i]));
        for (std::size_t i = 0; i < b.arms.size(); ++i) {
            const Height h = height(b, i, axis);
            if (h.value <= low + nearest) low_rate = std::min(low_rate, h.rate);
        }
        for (std::size_t i = 0; i < a.arms.size(); ++i) {
            const Height h = height(a, i, axis);
            if (h.value >= high - nearest) high_rate = std::max(high_rate, h.rate);
        }
        bound.rate = centers.rate + low_rate - high_rate;
    }

    // Q. |n'| and |n''| are n1 and n1^2 for a uniformly rotating axis; a point's motion about its center has |b'| <= W
    // r and |b''| <= (W^2 + |alpha|) r.
    const double n1 = axis.rate.norm(), n2 = n1 * n1;
    const double turning = a.reach * (n2 + 2.0 * n1 * a.spin_bound + a.turning_bound) +
                           b.reach * (n2 + 2.0 * n1 * b.spin_bound + b.turning_bound);
    const double change = a.acceleration_change + b.acceleration_change;
    const double shift = std::max(0.0, -bound.gap);  // overlap by rounding or by a touch: treated as just touching
    double window = n1 > 0.0 ? std::min(horizon, 1.0 / n1) : horizon;  // one radian of rotation is a sufficient horizon
    for (int round = 0; round < 3; ++round) {
        // For a fixed axis only the component of the centers' acceleration along it counts; a rotating axis may rotate
        // towards the acceleration, and the distance of the centers enters.
        double q = turning + change;
        if (n1 > 0.0) {
            const double away = d.norm() + window * (v.norm() + 0.5 * window * (acceleration.norm() + change));
            const double speed = v.norm() + window * (acceleration.norm() + change);
            q += std::max(0.0, -axis.normal.dot(acceleration)) + acceleration.norm() * std::min(1.0, n1 * window) +
                 n2 * away + 2.0 * n1 * speed;
        } else {
            q += std::max(0.0, -axis.normal.dot(acceleration));
        }
        bound.curvature = q;
        // The bound is a concave function of s: each pair's root lies at or beyond its first root. Descending from pair
        // to pair, the root is found at which its pair is also the lowest.
        Height active = line;
        double s = first_root(active.value + shift, active.rate, q);
        for (int k = 0; k < 32; ++k) {
            if (!(s > 0.0)) break;
            const double at = std::min(s, window);
            const Height next = lowest_line(a, b, axis, centers, at);
            if (next.at(at) + shift - 0.5 * q * at * at >= 0.0) {
                s = at;
                break;
            }
            if (next.value == active.value && next.rate == active.rate) break;
            active = next;
            s = std::min(s, first_root(active.value + shift, active.rate, q));
        }
        // The rounding error beyond the root is far below the rounding of the value itself.
        s = std::min(s, window);
        bound.safe_time = std::max(bound.safe_time, s);
        if (n1 == 0.0 || 4.0 * s > window) break;
        window = 2.0 * s;  // in a shorter window the rotation of the axis costs less
        if (!(window > 0.0)) break;
    }
    return bound;
}

}  // namespace tumble
