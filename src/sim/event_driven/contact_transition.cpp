#include "sim/event_driven/contact_transition.h"

#include "sim/contact/direct/settings.h"
#include "sim/event_driven/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

// Acceleration of the body's point at `arm` without contacts: g + alpha x r + omega x (omega x r),
// alpha = -I^-1 (omega x L).
Vec3 free_acceleration(const Body& body, const Vec3& arm, const Vec3& gravity, bool supported) {
    if (supported || !body.dynamic()) return Vec3::Zero();
    const Vec3& omega = body.angular_velocity;
    const Vec3 alpha = -(body.inverse_inertia * omega.cross(body.angular_momentum));
    return gravity + alpha.cross(arm) + omega.cross(omega.cross(arm));
}

// n' of the contact's normal (1/s): it rotates with the body whose face it is; of crossing edges n stays across both,
// so that with c = e_a x e_b, n' is the component of c' / |c| across n.
Vec3 normal_rate(const Contact& c, const PointGeometry& geometry, const Body& a, const Body& b) {
    const auto* ball = std::get_if<BallOverFace>(&geometry);
    if (c.corners == Corners::of_a || (ball && ball->ball_of_a)) return b.angular_velocity.cross(c.normal);
    if (c.corners == Corners::of_b || ball) return a.angular_velocity.cross(c.normal);
    const auto* edges = std::get_if<CrossingEdges>(&geometry);
    if (!edges) return Vec3::Zero();
    const Vec3 across = edges->of_a.cross(edges->of_b);
    const double length = across.norm();
    if (!(length > 0.0)) return Vec3::Zero();
    const Vec3 change = a.angular_velocity.cross(edges->of_a).cross(edges->of_b) +
                        edges->of_a.cross(b.angular_velocity.cross(edges->of_b));
    const double sign = across.dot(c.normal) < 0.0 ? -1.0 : 1.0;
    return sign / length * (change - c.normal.dot(change) * c.normal);
}

// Contribution of the normal's rotation to the acceleration along n, for points with the relative velocity v. For the
// gap between two points, d n, or between a point and a line along the unit e, less a radius: with s = d n.e,
// d'' = n.a + (v^2 - (n.v)^2 - s'^2) / d. For any other gap: d/dt (n.v) = n.a + 2 n'.v (Baraff 1997, "Physically Based
// Modeling", resting contact).
double turning(const Contact& c, const ContactGap& gap, const Body& a, const Body& b, const Vec3& v) {
    const auto* curve = std::get_if<CurvedGap>(&gap.geometry);
    if (!curve) return 2.0 * normal_rate(c, gap.geometry, a, b).dot(v);
    const double distance = (b.position + gap.arm_b - a.position - gap.arm_a).norm();
    if (!(distance > 0.0)) return 0.0;
    const Body& edged = std::holds_alternative<Ball>(a.collider) ? b : a;
    const double along = v.dot(curve->line) + distance * c.normal.dot(edged.angular_velocity.cross(curve->line));
    return ((v - c.normal.dot(v) * c.normal).squaredNorm() - along * along) / distance;
}

// A sum whose terms cancel up to rounding is set to zero.
double beyond_rounding(double sum, double terms) {
    return std::abs(sum) > tuning::pressing_rounding * terms ? sum : 0.0;
}

}  // namespace

void make_gaps(const std::vector<Manifold>& manifolds, const std::vector<Contact>& contacts,
               const std::vector<Body>& bodies, std::vector<ContactGap>& gaps) {
    gaps.clear();
    for (const Manifold& m : manifolds) {
        ContactGap gap{m.geometry()};
        const auto* curve = std::get_if<CurvedGap>(&gap.geometry);
        const auto* ball = std::get_if<BallOverFace>(&gap.geometry);
        for (int i = 0; i < m.count; ++i) {
            const Contact& c = contacts[gaps.size()];
            const bool own = !curve && !ball;
            gap.arm_a = own ? c.arm_a : Vec3((curve ? curve->on_a : ball->center) - bodies[m.a].position);
            gap.arm_b = own ? c.arm_b : Vec3((curve ? curve->on_b : ball->center) - bodies[m.b].position);
            gaps.push_back(gap);
        }
    }
}

double pressing_acceleration(const Contact& c, const ContactGap& gap, const Body& a, const Body& b, const Vec3& gravity,
                             bool a_supported, bool b_supported) {
    const Vec3 &arm_a = gap.arm_a, &arm_b = gap.arm_b;
    const Vec3 of_a = free_acceleration(a, arm_a, gravity, a_supported),
               of_b = free_acceleration(b, arm_b, gravity, b_supported);
    const double more = turning(c, gap, a, b, b.point_velocity(arm_b) - a.point_velocity(arm_a));
    return beyond_rounding(c.normal.dot(of_b - of_a) + more, of_a.norm() + of_b.norm() + std::abs(more));
}

void mark_held(const std::vector<Contact>& contacts, const std::vector<ContactGap>& gaps,
               const std::vector<Body>& bodies, const Vec3& gravity, double near, double release,
               std::vector<bool>& held) {
    std::vector<std::uint32_t> found;
    do {  // in rounds: the result must not depend on the contacts' order
        found.clear();
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            const Contact& c = contacts[i];
            const Body &a = bodies[c.a], &b = bodies[c.b];
            if (!(c.separation <= std::max(c.touch_distance, near)) || (held[c.a] && held[c.b])) continue;
            // Position correction leaves this overlap to a resting body, to the last digit: it alone does not hold the
            // body.
            const double left = tuning::direct_slop * std::min(a.radius, b.radius);
            const bool overlap = c.separation < -(left + c.touch_distance);
            if (!overlap) {
                if (relative_velocity(c, a, b) > release) continue;
                const bool a_stands = !a.dynamic() || a.asleep || held[c.a],
                           b_stands = !b.dynamic() || b.asleep || held[c.b];
                if (!(pressing_acceleration(c, gaps[i], a, b, gravity, a_stands, b_stands) < 0.0)) continue;
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

double harmless_time(const MovingBody& a, const MovingBody& b) {
    double size = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const MovingBody* t : {&a, &b}) {
        if (!t->body->moves()) continue;
        size = std::min(size, t->body->radius);
        most += t->path->acceleration(t->since).norm() + t->path->turning_bound() * t->body->radius;
    }
    return std::sqrt(2.0 * tuning::impact_harmless * size / most);
}

}  // namespace tumble
