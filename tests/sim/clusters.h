// Random clusters of bodies with contacts between them, made without any geometry: the input of the impact laws.
#pragma once

#include "random_shapes.h"
#include "sim/impact/impact_system.h"

#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace tumble::testing {

inline Body random_body(Random& random, BodyType type, double lightest, double heaviest) {
    Body body;
    body.type = type;
    body.radius = 1.0;
    body.position = random.vector(2.0);
    body.orientation = random.turn();
    body.rotation = body.orientation.toRotationMatrix();
    if (type == BodyType::dynamic) {
        body.mass = random(lightest, heaviest);
        body.inverse_mass = 1.0 / body.mass;
        body.inertia_body = (body.mass * Vec3(random(0.3, 0.5), random(0.3, 0.5), random(0.3, 0.5))).asDiagonal();
        body.inverse_inertia_body = body.inertia_body.inverse();
        body.momentum = body.mass * random.vector(3.0);
        body.angular_momentum = body.mass * random.vector(1.0);
        body.derive();
    }
    return body;
}

/// A touching manifold of `count` points about the middle of the two bodies, normal from a to b.
inline Manifold random_manifold(Random& random, const std::vector<Body>& bodies, std::uint32_t a, std::uint32_t b,
                                int count) {
    Manifold m;
    m.a = a;
    m.b = b;
    m.count = count;
    const Vec3 way = bodies[b].position - bodies[a].position;
    m.normal = (way.normalized() + random.vector(0.3)).normalized();
    const Vec3 t = m.normal.unitOrthogonal(), s = m.normal.cross(t);
    for (int i = 0; i < count; ++i) {
        auto& p = m.points[std::size_t(i)];
        p.position = 0.5 * (bodies[a].position + bodies[b].position) + random(-0.4, 0.4) * t + random(-0.4, 0.4) * s;
        p.feature = std::uint64_t(i);
    }
    return m;
}

struct Totals {
    double kinetic = 0.0;
    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
};

inline Totals totals(const std::vector<Body>& bodies) {
    Totals t;
    for (const Body& b : bodies) {
        if (!b.dynamic()) continue;
        t.kinetic += 0.5 * (b.momentum.dot(b.velocity) + b.angular_momentum.dot(b.angular_velocity));
        t.momentum += b.momentum;
        t.angular += b.position.cross(b.momentum) + b.angular_momentum;
    }
    return t;
}

/// The islands of the contacts, by their lowest body: labels spread until nothing changes.
inline std::vector<Island> islands_of(const std::vector<Contact>& contacts, const std::vector<Body>& bodies) {
    std::vector<std::uint32_t> label(bodies.size());
    std::iota(label.begin(), label.end(), 0u);
    for (bool changed = true; changed;) {
        changed = false;
        for (const Contact& c : contacts) {
            if (!bodies[c.a].dynamic() || !bodies[c.b].dynamic() || label[c.a] == label[c.b]) continue;
            label[c.a] = label[c.b] = std::min(label[c.a], label[c.b]);
            changed = true;
        }
    }
    std::map<std::uint32_t, Island> found;
    std::set<std::uint32_t> touched;
    for (const Contact& c : contacts) touched.insert({c.a, c.b});
    for (const std::uint32_t i : touched)
        if (bodies[i].dynamic()) found[label[i]].bodies.push_back(i);
    for (std::uint32_t k = 0; k < contacts.size(); ++k)
        found[label[bodies[contacts[k].a].dynamic() ? contacts[k].a : contacts[k].b]].contacts.push_back(k);
    std::vector<Island> islands;
    for (auto& [lowest, island] : found) islands.push_back(std::move(island));
    return islands;
}

}  // namespace tumble::testing
