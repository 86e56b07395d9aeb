#include "sim/flight/landing.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Of the body's point at `arm`, without contacts: g + alpha x r + omega x (omega x r), alpha = -I^-1 (omega x L).
Vec3 free_acceleration(const Body& body, const Vec3& arm, const Vec3& gravity, bool supported) {
    if (supported || !body.dynamic()) return Vec3::Zero();
    const Vec3& omega = body.angular_velocity;
    const Vec3 alpha = -(body.inverse_inertia * omega.cross(body.angular_momentum));
    return gravity + alpha.cross(arm) + omega.cross(omega.cross(arm));
}

// n' of the contact's normal (1/s): with the body whose face it is; of crossing edges n stays across both, so that with
// c = e_a x e_b, n' is the part of c' / |c| across n. Elsewhere, on balls, it is the business of pressing_acceleration().
Vec3 normal_rate(const Contact& c, const Body& a, const Body& b) {
    if (c.corners == Corners::of_a) return b.angular_velocity.cross(c.normal);
    if (c.corners == Corners::of_b) return a.angular_velocity.cross(c.normal);
    const Vec3 across = c.edge_a.cross(c.edge_b);
    const double length = across.norm();
    if (!(length > 0.0)) return Vec3::Zero();
    const Vec3 change = a.angular_velocity.cross(c.edge_a).cross(c.edge_b) + c.edge_a.cross(b.angular_velocity.cross(c.edge_b));
    const double sign = across.dot(c.normal) < 0.0 ? -1.0 : 1.0;
    return sign / length * (change - c.normal.dot(change) * c.normal);
}

// A sum whose terms cancel but for rounding is none.
double beyond_rounding(double sum, double terms) { return std::abs(sum) > tuning::pressing_rounding * terms ? sum : 0.0; }

}  // namespace

double pressing_acceleration(const Contact& c, const Body& a, const Body& b, const Vec3& gravity, bool a_supported, bool b_supported) {
    const auto *ball_a = std::get_if<Ball>(&a.collider), *ball_b = std::get_if<Ball>(&b.collider);
    if (ball_a || ball_b) {
        // Of a ball only the centre counts. Two balls' normal turns with the line between them: + v_t^2 / d.
        const Vec3 of_a = ball_a ? (a_supported || !a.dynamic() ? Vec3(Vec3::Zero()) : gravity) : free_acceleration(a, c.arm_a, gravity, a_supported);
        const Vec3 of_b = ball_b ? (b_supported || !b.dynamic() ? Vec3(Vec3::Zero()) : gravity) : free_acceleration(b, c.arm_b, gravity, b_supported);
        double turning = 0.0;
        if (ball_a && ball_b) {
            const Vec3 v = b.velocity - a.velocity, across = v - c.normal.dot(v) * c.normal;
            turning = across.squaredNorm() / (ball_a->radius + ball_b->radius);
        }
        return beyond_rounding(c.normal.dot(of_b - of_a) + turning, of_a.norm() + of_b.norm() + turning);
    }
    const Vec3 v = b.point_velocity(c.arm_b) - a.point_velocity(c.arm_a);
    // d/dt (n.v) = n.a + 2 n'.v (Baraff 1997, "Physically Based Modeling", resting contact).
    const Vec3 of_a = free_acceleration(a, c.arm_a, gravity, a_supported), of_b = free_acceleration(b, c.arm_b, gravity, b_supported);
    const double turning = 2.0 * normal_rate(c, a, b).dot(v);
    return beyond_rounding(c.normal.dot(of_b - of_a) + turning, of_a.norm() + of_b.norm() + std::abs(turning));
}

void mark_held(const std::vector<Contact>& contacts, const std::vector<Body>& bodies, const Vec3& gravity, double near, double release,
               std::vector<bool>& held) {
    std::vector<std::uint32_t> found;
    do {   // in rounds: whom a contact holds does not hang on the contacts' order
        found.clear();
        for (const Contact& c : contacts) {
            const Body &a = bodies[c.a], &b = bodies[c.b];
            if (!(c.separation <= std::max(c.touch_distance, near)) || (held[c.a] && held[c.b])) continue;
            // What rests overlaps by as much as is not pushed out, to the last digit: that is no overlap to be held for.
            const double left = tuning::direct_slop * std::min(a.radius, b.radius);
            const bool overlap = c.separation < -(left + c.touch_distance);
            if (!overlap) {
                if (relative_velocity(c, a, b) > release) continue;
                const bool a_stands = !a.dynamic() || a.asleep || held[c.a], b_stands = !b.dynamic() || b.asleep || held[c.b];
                if (!(pressing_acceleration(c, a, b, gravity, a_stands, b_stands) < 0.0)) continue;
            }
            for (const std::uint32_t k : {c.a, c.b})
                if (bodies[k].dynamic() && !held[k]) found.push_back(k);
        }
        for (const std::uint32_t k : found) held[k] = true;
    } while (!found.empty());
}

bool hop_is_shorter(const Contact& c, const Body& a, const Body& b, double acceleration, double time) {
    if (acceleration >= 0.0) return false;
    const double v = relative_velocity(c, a, b);
    if (2.0 * v < -acceleration * time) return true;
    return v * v < -2.0 * acceleration * (gap_rounding(a, a.position) + gap_rounding(b, b.position));
}

double harmless_time(const Traveller& a, const Traveller& b) {
    double size = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const Traveller* t : {&a, &b}) {
        if (!t->body->moves()) continue;
        size = std::min(size, t->body->radius);
        most += t->path->acceleration(t->since).norm() + t->path->turning_bound() * t->body->radius;
    }
    return std::sqrt(2.0 * tuning::impact_harmless * size / most);
}

}  // namespace tumble
