#include "accuracy/scene.h"

#include <numbers>

namespace tumble::bench {

Orientation turn(const Vector& axis, double radians) {
    const Vector u = std::sin(0.5 * radians) / norm(axis) * axis;
    return {std::cos(0.5 * radians), u.x, u.y, u.z};
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
    const double xx = size.x * size.x, yy = size.y * size.y, zz = size.z * size.z;
    return {mass / 12.0 * (yy + zz), mass / 12.0 * (xx + zz), mass / 12.0 * (xx + yy)};
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
    return sum;
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
