#include "sim/contact/model/free_motion.h"

#include "sim/contact/model/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Relative accelerations of touching points below this share of their terms are rounding. Not fitted: rounding.
constexpr double pressing_rounding = 1e-12;

// The body on whose face the contact lies, or null.
const Body* face_of(const Gap& gap, const Body& a, const Body& b) {
    const auto* ball = std::get_if<BallOverFace>(&gap.geometry);
    if (gap.corners == Corners::of_a || (ball && ball->ball_of_a)) return &b;
    return gap.corners == Corners::of_b || ball ? &a : nullptr;
}

// n' of the gap's normal (1/s): it rotates with the body whose face it is; of crossing edges n stays across both,
// so that with c = e_a x e_b, n' is the component of c' / |c| across n.
Vec3 normal_rate(const Gap& gap, const Body& a, const Body& b) {
    if (const Body* face = face_of(gap, a, b)) return face->angular_velocity.cross(gap.normal);
    const auto* edges = std::get_if<CrossingEdges>(&gap.geometry);
    if (!edges) return Vec3::Zero();
    const Vec3 across = edges->of_a.cross(edges->of_b);
    const double length = across.norm();
    if (!(length > 0.0)) return Vec3::Zero();
    const Vec3 change = a.angular_velocity.cross(edges->of_a).cross(edges->of_b) +
                        edges->of_a.cross(b.angular_velocity.cross(edges->of_b));
    const double sign = across.dot(gap.normal) < 0.0 ? -1.0 : 1.0;
    return sign / length * (change - gap.normal.dot(change) * gap.normal);
}

// Contribution of the normal's rotation to the acceleration along n, for points with the relative velocity v. For the
// gap between two points, d n, or between a point and a line along the unit e, less a radius: with s = d n.e,
// d'' = n.a + (v^2 - (n.v)^2 - s'^2) / d. For any other gap: d/dt (n.v) = n.a + 2 n'.v (Baraff 1997, "Physically Based
// Modeling", resting contact).
double turning(const Gap& gap, const Body& a, const Body& b, const Vec3& v) {
    const auto* curve = std::get_if<CurvedGap>(&gap.geometry);
    if (!curve) return 2.0 * normal_rate(gap, a, b).dot(v);
    const double distance = (b.position + gap.arm_b - a.position - gap.arm_a).norm();
    if (!(distance > 0.0)) return 0.0;
    const Body& edged = std::holds_alternative<Ball>(a.collider) ? b : a;
    const double along = v.dot(curve->line) + distance * gap.normal.dot(edged.angular_velocity.cross(curve->line));
    return ((v - gap.normal.dot(v) * gap.normal).squaredNorm() - along * along) / distance;
}

// A sum whose terms cancel up to rounding is set to zero.
double beyond_rounding(double sum, double terms) { return std::abs(sum) > pressing_rounding * terms ? sum : 0.0; }

// Change of the body's speed along n at `place` by the impulses of the last step.
double load_change(const Manifold& m, const Body& body, const Vec3& place) {
    if (!body.dynamic()) return 0.0;
    Vec3 turn = Vec3::Zero();
    double sum = 0.0;
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        turn += p.impulse * (p.position - body.position).cross(m.normal);
        sum += p.impulse;
    }
    return sum * body.inverse_mass + m.normal.dot((body.inverse_inertia * turn).cross(place - body.position));
}

}  // namespace

Vec3 FreeMotion::by_forces(std::uint32_t body, const Body& state) const {
    if (forces.only_gravity(body)) return state.fall(forces.gravity());
    return state.inverse_mass * forces.throughout(body, state, from, to).force;
}

Vec3 FreeMotion::acceleration(std::uint32_t body, const Body& state, const Vec3& arm) const {
    const Vec3& w = state.angular_velocity;
    if (state.dynamic()) {
        const Vec3 torque =
            forces.only_gravity(body) ? Vec3(Vec3::Zero()) : forces.throughout(body, state, from, to).torque;
        const Vec3 turn = state.inverse_inertia * (torque - w.cross(state.angular_momentum));
        return by_forces(body, state) + turn.cross(arm) + w.cross(w.cross(arm));
    }
    if (!state.track) return Vec3::Zero();
    // Over the coming step: twice the difference of its mean velocity from that at its start.
    const BodyVelocity& start = at_start[body];
    return 2.0 / h * (state.velocity - start.velocity + (w - start.angular_velocity).cross(arm)) +
           w.cross(w.cross(arm));
}

Gap gap_of(const Manifold& m, int point, const Body& a, const Body& b) {
    Gap gap{m.normal, m.corners, m.geometry(m.has_ball_over_face() ? point : 0), Vec3::Zero(), Vec3::Zero()};
    Vec3 on_a = m.points[std::size_t(point)].position, on_b = on_a;
    if (const auto* ball = std::get_if<BallOverFace>(&gap.geometry)) on_a = on_b = ball->center;
    if (const auto* curve = std::get_if<CurvedGap>(&gap.geometry)) on_a = curve->on_a, on_b = curve->on_b;
    gap.arm_a = on_a - a.position;
    gap.arm_b = on_b - b.position;
    return gap;
}

void make_gaps(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies, std::vector<Gap>& gaps) {
    gaps.clear();
    for (const Manifold& m : manifolds)
        for (int i = 0; i < m.count; ++i) gaps.push_back(gap_of(m, i, bodies[m.a], bodies[m.b]));
}

double gap_acceleration(const Gap& gap, const Body& a, const Body& b, const Vec3& of_a, const Vec3& of_b) {
    const double more = turning(gap, a, b, b.point_velocity(gap.arm_b) - a.point_velocity(gap.arm_a));
    return beyond_rounding(gap.normal.dot(of_b - of_a) + more, of_a.norm() + of_b.norm() + std::abs(more));
}

double last_load(const Manifold& m, int point, const Body& a, const Body& b) {
    const Vec3& place = m.points[std::size_t(point)].position;
    return load_change(m, a, place) + load_change(m, b, place);
}

double load_speed(const Manifold& m, int point, const Body& a, const Body& b, const FreeMotion& free) {
    const double last = last_load(m, point, a, b);
    const Gap gap = gap_of(m, point, a, b);
    // The rotation of dynamic bodies is left out: it is no load, and too fast for its acceleration in coarse steps.
    const auto pushed = [&](std::uint32_t k, const Body& body, const Vec3& arm) -> Vec3 {
        return body.dynamic() ? free.by_forces(k, body) : free.acceleration(k, body, arm);
    };
    const Body* face = face_of(gap, a, b);
    Vec3 turn = Vec3::Zero();
    if (face && !face->dynamic()) turn = face->angular_velocity.cross(gap.normal);
    const Vec3 relative = b.point_velocity(gap.arm_b) - a.point_velocity(gap.arm_a);
    const double now = gap.normal.dot(pushed(m.b, b, gap.arm_b) - pushed(m.a, a, gap.arm_a)) + 2.0 * turn.dot(relative);
    return std::max({0.0, tuning::load_left * last, -free.h * now});
}

}  // namespace tumble
