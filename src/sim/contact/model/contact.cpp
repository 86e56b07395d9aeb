#include "sim/contact/model/contact.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/geometry/contact_tolerance.h"

#include <algorithm>
#include <span>

namespace tumble {

double relative_velocity(const Contact& c, const Body& a, const Body& b) {
    return c.normal.dot(b.point_velocity(c.arm_b) - a.point_velocity(c.arm_a));
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

void add_impact(const Contact& c, Body& a, Body& b) {
    add_impulse(c, c.impact * c.normal + c.impact_friction, a, b);
    const Vec3 moment = c.rub.cross(c.impact_friction);
    if (a.dynamic()) a.angular_momentum -= moment;
    if (b.dynamic()) b.angular_momentum += moment;
}

namespace {

// Uniform pressure resists a spin as its points would with their distances from the friction point scaled by the
// spread.
void set_rubbing(const Manifold& m, std::span<Contact> contacts) {
    const auto touching =
        std::size_t(std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.touching(); }));
    if (touching < 2) return;
    const bool whole = touching == contacts.size();
    Vec3 center = Vec3::Zero();  // relative to A's center
    double weights = 0.0;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        if (!contacts[i].touching()) continue;
        const double weight = whole ? double(m.share[i]) : 1.0;
        center += weight * contacts[i].arm_a;
        weights += weight;
    }
    center /= weights;
    for (Contact& c : contacts)
        if (c.touching()) c.rub = (1.0 - double(m.spread)) * (center - c.arm_a);
}

}  // namespace

void add_contacts(const Manifold& m, const std::vector<Body>& bodies, std::vector<Contact>& contacts) {
    const Body &a = bodies[m.a], &b = bodies[m.b];
    Contact c;
    c.a = m.a;
    c.b = m.b;
    c.part = m.part;
    c.points = m.count;
    c.normal = m.normal;
    c.restitution = pair_restitution(a, b);
    c.friction = pair_friction(a, b);
    c.touch_distance = touch_distance(a.radius, b.radius);
    c.corners = m.corners;
    c.kind = m.kind;
    for (int i = 0; i < m.count; ++i) {
        const ContactPoint& p = m.points[std::size_t(i)];
        c.feature = p.feature;
        c.separation = p.separation;
        const Vec3 place = acting_point(p.position, p.separation, m.normal, a.dynamic(), b.dynamic());
        c.arm_a = place - a.position;
        c.arm_b = place - b.position;
        contacts.push_back(c);
    }
    if (m.count > 1) set_rubbing(m, std::span(contacts).last(std::size_t(m.count)));
}

void make_contacts(const std::vector<Manifold>& manifolds, const std::vector<Body>& bodies,
                   std::vector<Contact>& contacts) {
    contacts.clear();
    for (const Manifold& m : manifolds) add_contacts(m, bodies, contacts);
}

}  // namespace tumble
