#include "sim/ccd/separation.h"

#include "sim/geometry/nearest_simplex.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {

namespace {

/// Share of the distance to which that of a curved body is searched: its axis is only a proposal.
constexpr double curved_distance = 1e-6;

Vec3 farthest(const SupportPoints& points, const Vec3& direction) {
    if (points.curved)
        return points.place + points.rotation * points.curved->support(points.rotation.transpose() * direction);
    const Vec3* best = &points.arms[0];
    double most = direction.dot(*best);
    for (const Vec3& arm : points.arms) {
        const double d = direction.dot(arm);
        if (d > most) {
            most = d;
            best = &arm;
        }
    }
    return *best;
}

// The arms farthest along a direction, up to three: enough to distinguish a corner, an edge and a face.
struct Feature {
    std::array<Vec3, 3> arms{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    int size = 0;
};

Feature feature_along(const SupportPoints& points, const Vec3& direction, double tolerance) {
    const double most = direction.dot(farthest(points, direction)) - tolerance;
    Feature feature;
    for (const Vec3& arm : points.arms)
        if (direction.dot(arm) >= most && feature.size < 3) feature.arms[std::size_t(feature.size++)] = arm;
    return feature;
}

Vec3 perpendicular(const Vec3& v, const Vec3& normal) { return v - normal.dot(v) * normal; }

// n ~ the component of w = q - p across the edge e (unit, rotating at omega): n' = (u' - n (n.u')) / |u|.
Vec3 rate_from_edge(const Vec3& normal, const Vec3& edge, const Vec3& omega, const Vec3& w, const Vec3& w_rate) {
    const Vec3 u = w - w.dot(edge) * edge;
    const double length = u.norm();
    if (length == 0.0) return Vec3::Zero();
    const Vec3 edge_rate = omega.cross(edge);
    const Vec3 u_rate = w_rate - (w_rate.dot(edge) + w.dot(edge_rate)) * edge - w.dot(edge) * edge_rate;
    return perpendicular(u_rate, normal) / length;
}

}  // namespace

std::optional<Vec3> closest_vector(const SupportPoints& a, const SupportPoints& b, const Vec3& guess) {
    const Vec3 d = b.center - a.center;
    const double scale = a.reach + b.reach + d.norm();
    const double enough = a.curved || b.curved ? curved_distance : 1e-13;
    Simplex simplex;
    Vec3 v = guess;
    simplex.points[0] = d + farthest(b, -v) - farthest(a, v);
    simplex.size = 1;
    v = simplex.points[0];
    for (int round = 0; round < 64; ++round) {
        const double square = v.squaredNorm();
        if (square <= 1e-28 * scale * scale) return std::nullopt;
        const Vec3 w = d + farthest(b, -v) - farthest(a, v);
        // w is no nearer along v than the present point: converged, to a relative 1e-13.
        if (square - v.dot(w) <= enough * square) return v;
        for (int i = 0; i < simplex.size; ++i)
            if (simplex.points[std::size_t(i)] == w) return v;
        simplex.points[std::size_t(simplex.size++)] = w;
        const Vec3 next = nearest(simplex);
        if (next.squaredNorm() >= square) return v;  // rounding stops the descent
        v = next;
        if (simplex.size == 4) return std::nullopt;
    }
    return v;
}

TrackedAxis tracking_axis(const SupportPoints& a, const SupportPoints& b, const Vec3& normal, double tolerance) {
    if (a.curved || b.curved) return {normal, Vec3::Zero()};  // the point of contact moves over the surface
    const Feature fa = feature_along(a, normal, tolerance), fb = feature_along(b, -normal, tolerance);
    const Vec3 &omega_a = a.angular_velocity, &omega_b = b.angular_velocity;
    if (fa.size >= 3) return {normal, omega_a.cross(normal)};
    if (fb.size >= 3) return {normal, omega_b.cross(normal)};

    const Vec3 d = b.center - a.center, v = b.velocity - a.velocity;
    if (fa.size == 2 && fb.size == 2) {
        const Vec3 ea = (fa.arms[1] - fa.arms[0]).normalized(), eb = (fb.arms[1] - fb.arms[0]).normalized();
        const Vec3 c = ea.cross(eb);
        const double length = c.norm();
        if (length < 1e-6) return {normal, omega_a.cross(normal)};  // parallel edges: any axis that rotates with one
        const Vec3 c_rate = omega_a.cross(ea).cross(eb) + ea.cross(omega_b.cross(eb));
        const double sign = c.dot(normal) < 0.0 ? -1.0 : 1.0;
        return {normal, perpendicular(sign / length * c_rate, normal)};
    }
    const Vec3 &p = fa.arms[0], &q = fb.arms[0];
    const Vec3 w = d + q - p, w_rate = v + omega_b.cross(q) - omega_a.cross(p);
    // Two points too close for a direction of the line between them: the axis does not rotate.
    if (w.norm() <= tolerance) return {normal, Vec3::Zero()};
    if (fa.size == 2) return {normal, rate_from_edge(normal, (fa.arms[1] - p).normalized(), omega_a, w, w_rate)};
    if (fb.size == 2) return {normal, rate_from_edge(normal, (fb.arms[1] - q).normalized(), omega_b, w, w_rate)};
    return {normal, perpendicular(w_rate, normal) / w.norm()};
}

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

Height height(const SupportPoints& points, const Vec3& arm, const TrackedAxis& axis) {
    return {axis.normal.dot(arm), axis.rate.dot(arm) + axis.normal.dot(points.angular_velocity.cross(arm))};
}

// The highest point of a curved body along the axis at time s, or with `sign` -1 the lowest. Heights at that time are
// those along another direction now; of points within `near` (m) the fastest closing one.
Height extreme(const SupportPoints& points, const TrackedAxis& axis, double sign, double s, double near) {
    const Vec3 change = axis.rate + axis.normal.cross(points.angular_velocity);
    const double rate = change.norm(), ahead = rate > 0.0 ? near / (2.0 * points.reach * rate) : 0.0;
    return height(points, farthest(points, sign * (axis.normal + (s + ahead) * change)), axis);
}

// The lowest of B's points and the highest of A's at time s, as one line; at equal heights the faster closing one.
Height lowest_line(const SupportPoints& a, const SupportPoints& b, const TrackedAxis& axis, const Height& centers,
                   double s) {
    Height low{infinity, 0.0}, high{-infinity, 0.0};
    if (b.curved) low = extreme(b, axis, -1.0, s, 0.0);
    if (a.curved) high = extreme(a, axis, 1.0, s, 0.0);
    for (std::size_t i = 0; i < b.arms.size(); ++i) {
        const Height h = height(b, b.arms[i], axis);
        if (h.at(s) < low.at(s) || (h.at(s) == low.at(s) && h.rate < low.rate)) low = h;
    }
    for (std::size_t i = 0; i < a.arms.size(); ++i) {
        const Height h = height(a, a.arms[i], axis);
        if (h.at(s) > high.at(s) || (h.at(s) == high.at(s) && h.rate > high.rate)) high = h;
    }
    return {centers.value + low.value - high.value, centers.rate + low.rate - high.rate};
}

}  // namespace

SeparationBound bound_separation(const SupportPoints& a, const SupportPoints& b, const TrackedAxis& axis,
                                 double horizon, double nearest) {
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
            const Height h = height(b, b.arms[i], axis);
            if (h.value <= low + nearest) low_rate = std::min(low_rate, h.rate);
        }
        for (std::size_t i = 0; i < a.arms.size(); ++i) {
            const Height h = height(a, a.arms[i], axis);
            if (h.value >= high - nearest) high_rate = std::max(high_rate, h.rate);
        }
        if (b.curved) low_rate = extreme(b, axis, -1.0, 0.0, nearest).rate;
        if (a.curved) high_rate = extreme(a, axis, 1.0, 0.0, nearest).rate;
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
