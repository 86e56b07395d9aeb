#include "harness/scene.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace tumble::bench {
namespace {

// Integrals of x^2, y^2, z^2 over a hexahedron about the origin, over its volume: the sum of the tetrahedra that its
// sides, split in two, span with the origin.
Vector mean_squares(const Corners& c) {
    Vector sum;
    double volume = 0.0;
    const auto tetrahedron = [&](const Vector& p, const Vector& q, const Vector& r) {
        const double v = dot(p, cross(q, r)) / 6.0;
        const auto square = [](double a, double b, double d) {
            return (a * a + b * b + d * d + a * b + b * d + d * a) / 10.0;
        };
        sum = sum + v * Vector{square(p.x, q.x, r.x), square(p.y, q.y, r.y), square(p.z, q.z, r.z)};
        volume += v;
    };
    for (const auto& s : sides) {
        tetrahedron(c[std::size_t(s[0])], c[std::size_t(s[1])], c[std::size_t(s[2])]);
        tetrahedron(c[std::size_t(s[0])], c[std::size_t(s[2])], c[std::size_t(s[3])]);
    }
    return 1.0 / volume * sum;
}

// The mass of each part is proportional to its volume.
Vector compound_inertia(const Body& body) {
    double volume = 0.0;
    for (const BoxPart& part : body.parts) volume += part.size.x * part.size.y * part.size.z;
    Vector sum;
    for (const BoxPart& part : body.parts) {
        Body one;
        one.kind = Kind::box;
        one.size = part.size;
        one.mass = body.mass * part.size.x * part.size.y * part.size.z / volume;
        const Vector own = one.principal_inertia(), &p = part.position;
        const auto about = [&](const Vector& axis) {
            const Vector u = rotate_back(part.orientation, axis);
            return own.x * u.x * u.x + own.y * u.y * u.y + own.z * u.z * u.z +
                   one.mass * (dot(p, p) - dot(p, axis) * dot(p, axis));
        };
        sum = sum + Vector{about({1.0, 0.0, 0.0}), about({0.0, 1.0, 0.0}), about({0.0, 0.0, 1.0})};
    }
    return sum;
}

}  // namespace

Orientation turn(const Vector& axis, double radians) {
    const Vector u = std::sin(0.5 * radians) / norm(axis) * axis;
    return {std::cos(0.5 * radians), u.x, u.y, u.z};
}

Orientation operator*(const Orientation& a, const Orientation& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Vector rotate(const Orientation& q, const Vector& v) {
    const Vector u{q.x, q.y, q.z}, t = 2.0 * cross(u, v);
    return v + q.w * t + cross(u, t);
}

Vector rotate_back(const Orientation& q, const Vector& v) { return rotate({q.w, -q.x, -q.y, -q.z}, v); }

Vector Body::principal_inertia() const {
    if (kind == Kind::sphere) {
        const double i = 0.4 * mass * radius * radius;
        return {i, i, i};
    }
    if (kind == Kind::hexahedron) {
        const Vector m = mean_squares(corners);
        return {mass * (m.y + m.z), mass * (m.x + m.z), mass * (m.x + m.y)};
    }
    if (kind == Kind::compound) return compound_inertia(*this);
    const double xx = size.x * size.x, yy = size.y * size.y, zz = size.z * size.z;
    return {mass / 12.0 * (yy + zz), mass / 12.0 * (xx + zz), mass / 12.0 * (xx + yy)};
}

Corners Body::outline() const {
    if (kind == Kind::hexahedron) return corners;
    Corners c;
    for (std::size_t i = 0; i < 8; ++i)
        c[i] = {(i & 1 ? 0.5 : -0.5) * size.x, (i & 2 ? 0.5 : -0.5) * size.y, (i & 4 ? 0.5 : -0.5) * size.z};
    return c;
}

double Body::reach() const {
    if (kind == Kind::plane) return std::numeric_limits<double>::infinity();
    if (kind == Kind::sphere) return radius;
    double farthest = 0.0;
    if (kind == Kind::compound) {
        for (const BoxPart& part : parts) farthest = std::max(farthest, norm(part.position) + 0.5 * norm(part.size));
        return farthest;
    }
    for (const Vector& corner : outline()) farthest = std::max(farthest, norm(corner));
    return farthest;
}

double Water::surface(double x, double time) const {
    const double k = 2.0 * std::numbers::pi / wave_length;
    return 0.5 * wave_height * std::cos(k * x - std::sqrt(g * k) * time);
}

bool Scene::has_water_or_breakage() const {
    return water || std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return bool(body.breakage); });
}

double mean_projected_area(const Body& body) {
    if (body.kind == Kind::sphere) return std::numbers::pi * body.radius * body.radius;
    return 0.5 * (body.size.x * body.size.y + body.size.y * body.size.z + body.size.z * body.size.x);
}

Wrench wrench(const Scene& scene, std::size_t body, const Motion& motion) {
    Wrench sum;
    if (scene.air) {
        const Vector relative = scene.air->velocity - motion.velocity;
        const double pressure = 0.5 * scene.air->density * scene.air->drag * norm(relative);
        sum.force = pressure * mean_projected_area(scene.bodies[body]) * relative;
    }
    if (scene.push && body == 0) {
        const Vector force = rotate(motion.orientation, scene.push->force);
        sum.force = sum.force + force;
        sum.torque = cross(rotate(motion.orientation, scene.push->point), force);
    }
    for (const Torque& turning : scene.torques)
        if (turning.body == body) sum.torque = sum.torque + rotate(motion.orientation, turning.torque);
    for (const Spring& spring : scene.springs) {
        if (spring.body != body) continue;
        const Vector arm = rotate(motion.orientation, spring.point), pull = spring.from - (motion.position + arm);
        const Vector force = spring.stiffness * (1.0 - spring.length / norm(pull)) * pull;
        sum.force = sum.force + force;
        sum.torque = sum.torque + cross(arm, force);
    }
    return sum;
}

double told_friction(const Scene& scene, const Body& body) {
    if (body.moves()) return body.friction;
    for (const Body& other : scene.bodies)
        if (other.moves()) return std::sqrt(body.friction * other.friction);
    return body.friction;
}

Vector angular_momentum(const Body& body, const Motion& motion) {
    const Vector w = rotate_back(motion.orientation, motion.angular_velocity), i = body.principal_inertia();
    return rotate(motion.orientation, {i.x * w.x, i.y * w.y, i.z * w.z});
}

double energy(const Scene& scene, const std::vector<Motion>& motions) {
    double sum = 0.0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const Body& body = scene.bodies[i];
        if (!body.moves()) continue;
        const Motion& m = motions[i];
        sum += 0.5 * body.mass * dot(m.velocity, m.velocity) + body.mass * scene.gravity * m.position.z +
               0.5 * dot(m.angular_velocity, angular_momentum(body, m));
    }
    return sum;
}

}  // namespace tumble::bench
