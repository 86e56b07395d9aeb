#include "sim/contact/contact.h"

#include "sim/contact/contact_patch.h"
#include "sim/touch.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// n . ((I^-1 (r x u)) x r) for both bodies: how the points give way along v to an impulse along u.
double compliance(const Contact& c, const Body& a, const Body& b, const Vec3& u, const Vec3& v) {
    const Vec3 turn_a = a.inverse_inertia * c.arm_a.cross(u), turn_b = b.inverse_inertia * c.arm_b.cross(u);
    return (a.inverse_mass + b.inverse_mass) * u.dot(v) + turn_a.dot(c.arm_a.cross(v)) + turn_b.dot(c.arm_b.cross(v));
}

void derive(Contact& c, const Body& a, const Body& b) {
    c.turn_a = a.inverse_inertia * c.arm_a.cross(c.normal);
    c.turn_b = b.inverse_inertia * c.arm_b.cross(c.normal);
    c.inverse_effective_mass = compliance(c, a, b, c.normal, c.normal);
    if (c.friction <= 0.0) return;
    // The larger eigenvalue of the two-by-two compliance across the normal.
    int smallest = 0;
    c.normal.cwiseAbs().minCoeff(&smallest);
    const Vec3 t0 = c.normal.cross(Vec3::Unit(smallest)).normalized(), t1 = c.normal.cross(t0);
    const double k00 = compliance(c, a, b, t0, t0), k11 = compliance(c, a, b, t1, t1), k01 = compliance(c, a, b, t0, t1);
    c.inverse_tangent_mass = 0.5 * (k00 + k11 + std::sqrt((k00 - k11) * (k00 - k11) + 4.0 * k01 * k01));
}

}  // namespace

ContactState classify(double relative_velocity, double tolerance) {
    if (relative_velocity > tolerance) return ContactState::separating;
    if (relative_velocity < -tolerance) return ContactState::colliding;
    return ContactState::resting;
}

double relative_velocity(const Contact& c, const Body& a, const Body& b) {
    return c.normal.dot(b.point_velocity(c.arm_b) - a.point_velocity(c.arm_a));
}

double collision_impulse(const Contact& c, const Body& a, const Body& b) {
    return -(1.0 + c.restitution) * relative_velocity(c, a, b) / c.inverse_effective_mass;
}

void apply_to_velocities(const Vec3& impulse, const Contact& c, Body& a, Body& b) {
    if (a.dynamic()) {
        a.velocity -= a.inverse_mass * impulse;
        a.angular_velocity -= a.inverse_inertia * c.arm_a.cross(impulse);
    }
    if (b.dynamic()) {
        b.velocity += b.inverse_mass * impulse;
        b.angular_velocity += b.inverse_inertia * c.arm_b.cross(impulse);
    }
}

void apply_normal_to_velocities(double j, const Contact& c, Body& a, Body& b) {
    if (a.dynamic()) {
        a.velocity -= (j * a.inverse_mass) * c.normal;
        a.angular_velocity -= j * c.turn_a;
    }
    if (b.dynamic()) {
        b.velocity += (j * b.inverse_mass) * c.normal;
        b.angular_velocity += j * c.turn_b;
    }
}

void add_impulse(const Contact& c, const Vec3& impulse, Body& a, Body& b) {
    if (a.dynamic()) {
        a.momentum -= impulse;
        a.angular_momentum -= c.arm_a.cross(impulse);
    }
    if (b.dynamic()) {
        b.momentum += impulse;
        b.angular_momentum += c.arm_b.cross(impulse);
    }
}

void add_contacts(const Manifold& m, const std::vector<Body>& bodies, std::vector<Contact>& contacts) {
    const Body &a = bodies[m.a], &b = bodies[m.b];
    Contact c;
    c.a = m.a;
    c.b = m.b;
    c.part = m.part;
    c.normal = m.normal;
    c.restitution = pair_restitution(a, b);
    c.friction = pair_friction(a, b);
    c.touch_distance = touch_distance(a.radius, b.radius);
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        c.feature = p.feature;
        c.separation = p.separation;
        c.arm_a = p.position - a.position;
        c.arm_b = p.position - b.position;
        derive(c, a, b);
        contacts.push_back(c);
    }
}

void make_contacts(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies, std::vector<Contact>& contacts) {
    contacts.clear();
    for (const Manifold& m : manifolds) add_contacts(m, bodies, contacts);
}

}  // namespace tumble
