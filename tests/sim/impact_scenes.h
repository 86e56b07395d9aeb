// Impacts of several bodies set up by hand: balls, boxes and a floor, with the contacts between them.
#pragma once

#include "clusters.h"
#include "sim/impact/impacts.h"

#include <algorithm>
#include <cmath>

namespace tumble::testing {

struct ImpactScene {
    double restitution = 1.0, friction = 0.0;
    std::vector<Body> bodies;
    std::vector<Manifold> manifolds;
    std::vector<Contact> contacts;

    std::uint32_t add(BodyType type, double mass, const Vec3& inertia, const Vec3& position, const Vec3& velocity) {
        Body& body = bodies.emplace_back();
        body.type = type;
        body.radius = 0.5;
        body.position = position;
        body.restitution = restitution;
        body.friction = friction;
        body.velocity = velocity;
        if (type == BodyType::dynamic) {
            body.mass = mass;
            body.inverse_mass = 1.0 / mass;
            body.inertia_body = inertia.asDiagonal();
            body.inverse_inertia_body = inertia.cwiseInverse().asDiagonal();
            body.momentum = mass * velocity;
            body.derive();
        }
        return std::uint32_t(bodies.size() - 1);
    }
    std::uint32_t add_floor() { return add(BodyType::fixed, 0.0, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()); }
    std::uint32_t add_ball(double mass, const Vec3& position, const Vec3& velocity) {
        return add(BodyType::dynamic, mass, Vec3::Constant(0.4 * mass * 0.25), position, velocity);
    }
    std::uint32_t add_box(double mass, const Vec3& size, const Vec3& position, const Vec3& velocity) {
        const Vec3 s = size.cwiseAbs2();
        return add(BodyType::dynamic, mass, mass / 12.0 * Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()), position,
                   velocity);
    }
    void set_spin(std::uint32_t body, const Vec3& spin) {
        Body& b = bodies[body];
        b.angular_momentum = b.rotation * b.inertia_body * (b.rotation.transpose() * spin);
        b.derive();
        b.angular_velocity = spin;  // derive() loses six digits of a needle's spin
    }
    void touch(std::uint32_t a, std::uint32_t b, const Vec3& normal, const std::vector<Vec3>& points) {
        Manifold m;
        m.a = a;
        m.b = b;
        m.normal = normal;
        m.count = int(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            m.points[i].position = points[i];
            m.points[i].feature = i;
        }
        manifolds.push_back(m);
    }
    /// Two balls of radius 1/2 that touch.
    void touch_balls(std::uint32_t a, std::uint32_t b) {
        const Vec3 way = bodies[b].position - bodies[a].position;
        touch(a, b, way.normalized(), {bodies[a].position + 0.5 * way});
    }
    void touch_flat(std::uint32_t a, std::uint32_t b, double height, double x, double z) {
        touch(a, b, Vec3::UnitY(), {{-x, height, -z}, {x, height, -z}, {x, height, z}, {-x, height, z}});
    }

    /// Resolves it as the event-driven mode does, and leaves the result in the momenta. Returns the number of passes.
    int resolve(ImpactLaw law, bool complete = true) {
        std::stable_sort(manifolds.begin(), manifolds.end(), [](const Manifold& l, const Manifold& r) {
            return std::pair(l.a, l.b) < std::pair(r.a, r.b);
        });
        make_contacts(manifolds, bodies, contacts);
        const ImpactSettings settings{.law = law, .friction = friction > 0.0, .complete = complete};
        int passes = 0;
        for (const Island& island : islands_of(contacts, bodies))
            passes = std::max(passes, resolve_impacts(island, contacts, bodies, settings));
        for (const Contact& c : contacts) add_impact(c, bodies[c.a], bodies[c.b]);
        for (Body& b : bodies)
            if (b.dynamic()) b.derive();
        return passes;
    }

    double approach() const {
        double fastest = 0.0;
        for (const Contact& c : contacts) fastest = std::max(fastest, -relative_velocity(c, bodies[c.a], bodies[c.b]));
        return fastest;
    }
    double spin() const {
        double most = 0.0;
        for (const Body& b : bodies) most = std::max(most, b.angular_velocity.norm());
        return most;
    }
    /// From the momenta in the body's frame: exact for needles too.
    double kinetic() const {
        double sum = 0.0;
        for (const Body& b : bodies) {
            if (!b.dynamic()) continue;
            const Vec3 l = b.rotation.transpose() * b.angular_momentum;
            sum += 0.5 * (b.inverse_mass * b.momentum.squaredNorm() + l.dot(b.inverse_inertia_body * l));
        }
        return sum;
    }
};

/// A row of touching balls along x; the first `striking` of them arrive at 1 m/s.
inline ImpactScene cradle(int count, int striking, double restitution) {
    ImpactScene s;
    s.restitution = restitution;
    for (int i = 0; i < count; ++i) s.add_ball(1.0, Vec3(i, 0, 0), Vec3(i < striking ? 1.0 : 0.0, 0, 0));
    for (int i = 0; i + 1 < count; ++i) s.touch_balls(std::uint32_t(i), std::uint32_t(i + 1));
    return s;
}

inline ImpactScene box_stack(int layers, double restitution) {
    ImpactScene s;
    s.restitution = restitution;
    s.add_floor();
    for (int i = 0; i < layers; ++i) s.add_box(1.0, {1.0, 0.2, 0.6}, {0, 0.1 + 0.2 * i, 0}, {0, -1, 0});
    for (int i = 0; i < layers; ++i) s.touch_flat(std::uint32_t(i), std::uint32_t(i + 1), 0.2 * i, 0.5, 0.3);
    return s;
}

/// n x n balls side by side and on each other, all falling on the floor.
inline ImpactScene ball_wall(int n, double restitution) {
    ImpactScene s;
    s.restitution = restitution;
    const auto floor = s.add_floor();
    const auto at = [n](int i, int k) { return std::uint32_t(1 + k * n + i); };
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < n; ++i) s.add_ball(1.0, Vec3(i, k + 0.5, 0), Vec3(0, -1, 0));
    for (int k = 0; k < n; ++k)
        for (int i = 0; i < n; ++i) {
            if (k == 0) s.touch(floor, at(i, k), Vec3::UnitY(), {Vec3(i, 0, 0)});
            if (i + 1 < n) s.touch_balls(at(i, k), at(i + 1, k));
            if (k + 1 < n) s.touch_balls(at(i, k), at(i, k + 1));
        }
    return s;
}

/// Fifteen balls in a triangle with its tip towards the cue ball (body 0), which moves along y.
inline ImpactScene billiard_rack(double restitution) {
    ImpactScene s;
    s.restitution = restitution;
    s.add_ball(1.0, Vec3::Zero(), Vec3::UnitY());
    const auto at = [](int row, int k) { return std::uint32_t(1 + row * (row + 1) / 2 + k); };
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k)
            s.add_ball(1.0, Vec3(k - 0.5 * row, 1.0 + std::sqrt(0.75) * row, 0), Vec3::Zero());
    s.touch_balls(0, 1);
    for (int row = 0; row < 5; ++row)
        for (int k = 0; k <= row; ++k) {
            if (k < row) s.touch_balls(at(row, k), at(row, k + 1));
            if (row == 4) continue;
            s.touch_balls(at(row, k), at(row + 1, k));
            s.touch_balls(at(row, k), at(row + 1, k + 1));
        }
    return s;
}

/// Bodies of random masses and inertias with random contacts, some of them twice. Masses up to 10^(+-decades).
inline ImpactScene random_impact(Random& random, double decades, double e_low, double e_high, double friction = 0.0) {
    ImpactScene s;
    s.friction = friction;
    const int bodies = 2 + random.below(10);
    for (int i = 0; i < bodies; ++i) {
        s.restitution = random(e_low, e_high);
        const double mass = std::pow(10.0, random(-decades, decades));
        const auto body = s.add(i == 0 && random.below(2) ? BodyType::fixed : BodyType::dynamic, mass,
                                mass * Vec3(random(0.3, 0.5), random(0.3, 0.5), random(0.3, 0.5)), random.vector(1.0),
                                random.vector(1.0));
        Body& b = s.bodies[body];
        b.orientation = random.turn();
        b.rotation = b.orientation.toRotationMatrix();
        if (b.dynamic())
            s.set_spin(body, random.vector(1.0));
        else
            b.velocity.setZero();
    }
    const int contacts = 1 + random.below(3 * bodies);
    for (int i = 0; i < contacts; ++i) {
        const auto a = std::uint32_t(random.below(bodies)), b = std::uint32_t(random.below(bodies));
        if (a == b || (!s.bodies[a].dynamic() && !s.bodies[b].dynamic())) continue;
        const Vec3 point = 0.5 * (s.bodies[a].position + s.bodies[b].position) + random.vector(0.5);
        const Vec3 normal = random.vector(1.0).normalized();
        if (random.below(4) == 0)
            s.touch(a, b, normal, {point, point});
        else
            s.touch(a, b, normal, {point});
    }
    return s;
}

}  // namespace tumble::testing
