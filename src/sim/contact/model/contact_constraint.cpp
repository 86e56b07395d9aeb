#include "sim/contact/model/contact_constraint.h"

#include "sim/contact/model/free_motion.h"
#include "sim/contact/model/settings.h"
#include "sim/geometry/contact_tolerance.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Angle of a normal, rad, until two bodies without restitution meet: bodies that turn more are not stopped at the
/// surface, but meet in an overlap that the impact resolves. Related test:
/// OffCenter.BallsLeaveAlongTheLineOfTheirCenters.
constexpr double meeting_turn = 1e-3;

// The stored direction of friction; before the first step, any direction across the normal.
Vec3 tangent_of(const Manifold& m) {
    Vec3 t = m.tangent - m.normal.dot(m.tangent) * m.normal;
    const double square = t.squaredNorm();
    if (square > 0.25) return t / std::sqrt(square);
    // The coordinate axis at the largest angle to the normal.
    t = m.normal.x() * m.normal.x() < 0.36 ? Vec3::UnitX() : Vec3::UnitY();
    return (t - m.normal.dot(t) * m.normal).normalized();
}

}  // namespace

void release(Manifold& manifold) {
    for (ContactPoint& p : manifold.points) p.impulse = 0.0;
    manifold.friction[0] = manifold.friction[1] = manifold.torsion = 0.0;
    manifold.rolling[0] = manifold.rolling[1] = 0.0f;
}

double normal_impulse(const Manifold& manifold) {
    double sum = 0.0;
    for (const ContactPoint& p : manifold.points) sum += p.impulse;
    return sum;
}

void scale_impulses(Manifold& manifold, double share) {
    for (ContactPoint& p : manifold.points) p.impulse *= share;
    manifold.friction[0] *= share;
    manifold.friction[1] *= share;
    manifold.torsion *= share;
    for (float& impulse : manifold.rolling) impulse *= float(share);
}

double pair_restitution(const Body& a, const Body& b) {
    return pair_value(a.pair_rules.restitution, a.restitution, b.restitution);
}
double pair_friction(const Body& a, const Body& b) { return pair_value(a.pair_rules.friction, a.friction, b.friction); }

double relative_velocity(const ContactPoint& p, const Vec3& normal, const Body& a, const Body& b) {
    return normal.dot(b.point_velocity(p.position - b.position) - a.point_velocity(p.position - a.position));
}

bool ConstraintSettings::bounces(double approach, const Manifold& m, int point, const Body& a, const Body& b) const {
    const double e = pair_restitution(a, b);
    if (!(approach > bounce_threshold && e * approach > least_rebound)) return false;
    if (!free) return true;
    const double load = load_speed(m, point, a, b, *free);
    return approach > threshold_share * load && e * approach > rebound_share * load;
}

namespace {

// True if the normal of a curved gap turns until the bodies meet within the step.
bool turns_ahead(const Manifold& m, const Body& a, const Body& b, const ConstraintSettings& settings) {
    if (a.jointed || b.jointed) return false;
    const auto gap = std::get<CurvedGap>(m.geometry());
    Vec3 u = b.point_velocity(gap.on_b - b.position) - a.point_velocity(gap.on_a - a.position);
    u -= gap.line.dot(u) * gap.line;
    const double closing = -m.normal.dot(u), left = m.points[0].separation;
    if (!(closing > settings.bounce_threshold && closing * settings.h > left)) return false;
    return (u + closing * m.normal).norm() * left > meeting_turn * closing * gap.distance;
}

}  // namespace

bool will_bounce(const Manifold& m, int point, const Body& a, const Body& b, double slower,
                 const ConstraintSettings& settings) {
    const ContactPoint& p = m.points[std::size_t(point)];
    if (p.separation <= touch_distance(a.radius, b.radius)) return false;
    if (pair_restitution(a, b) <= 0.0) return settings.meets && m.has_curved_gap() && turns_ahead(m, a, b, settings);
    return settings.bounces(-(relative_velocity(p, m.normal, a, b) + slower), m, point, a, b);
}

Vec3 turn_of_carrier(const Body& carrier, const Vec3& motion, const Vec3& normal) {
    const Vec3 change = carrier.angular_velocity.cross(motion);
    return change - normal.dot(change) * normal;
}

ContactConstraint make_constraint(const Manifold& m, const BodiesInStep& bodies, const ConstraintSettings& settings) {
    const Body &a = bodies.a, &b = bodies.b;
    ContactConstraint constraint;
    constraint.size = std::min(a.radius, b.radius);
    const double near = tuning::friction_near * constraint.size;
    Vec3 center = Vec3::Zero(), of_area = Vec3::Zero();  // relative to A's center
    double weights = 0.0, shares = 0.0;
    bool whole = true;  // true if all of the area touches or nearly does
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& from = m.points[std::size_t(i)];
        const PredictedGap seen = predicted_gap(m, i, bodies, settings.h);
        if (will_bounce(m, i, a, b, seen.slower, settings)) continue;
        const Vec3 place = acting_point(seen.position, from.separation, m.normal, a.dynamic(), b.dynamic());
        const Vec3 arm_a = place - a.position, arm_b = place - b.position;
        ContactConstraint::Point& to = constraint.points[std::size_t(constraint.count++)];
        to.arm_a = arm_a;
        to.arm_b = arm_b;
        to.separation = seen.gap;
        to.impulse = from.impulse;
        to.source = i;
        const double weight = seen.gap < near ? 1.0 : tuning::friction_far_weight;
        center += weight * arm_a;
        weights += weight;
        const double share = double(m.share[std::size_t(i)]);
        of_area += share * arm_a;
        shares += share;
        whole = whole && seen.gap < near;
    }
    if (constraint.count == 0) return constraint;
    constraint.normal = m.normal;
    constraint.tangent_1 = tangent_of(m);
    constraint.tangent_2 = constraint.normal.cross(constraint.tangent_1);
    constraint.friction = pair_friction(a, b);
    constraint.friction_arm_a = whole ? of_area / shares : center / weights;
    constraint.spread = double(m.spread);
    constraint.friction_arm_b = constraint.friction_arm_a + (a.position - b.position);
    for (int i = 0; i < constraint.count; ++i) {
        ContactConstraint::Point& p = constraint.points[std::size_t(i)];
        p.lever = constraint.spread * (p.arm_a - constraint.friction_arm_a).norm();
    }
    return constraint;
}

}  // namespace tumble
