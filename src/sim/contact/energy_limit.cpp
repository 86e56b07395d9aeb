#include "sim/contact/energy_limit.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

double energy_limit(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds) {
    if (bodies.size() > tuning::soft_energy_bodies) return infinity;
    const double fast = tuning::soft_energy_turn * substeps_of(problem.patches.h) / problem.patches.h;
    if (std::none_of(bodies.begin(), bodies.end(),
                     [&](std::uint32_t i) { return problem.bodies[i].angular_velocity.squaredNorm() > fast * fast; }))
        return infinity;
    bool leans = false;
    for (const std::uint32_t k : manifolds)
        for (const std::uint32_t i : {problem.manifolds[k].a, problem.manifolds[k].b}) {
            const Body& body = problem.bodies[i];
            if (!body.dynamic() && body.moves()) return infinity;
            leans = leans || !body.dynamic();
        }
    if (!leans) return infinity;
    double before = 0.0, with_forces = 0.0;
    for (const std::uint32_t i : bodies) {
        const Body& body = problem.bodies[i];
        const BodyVelocity& start = problem.before[i];
        const Vec3 spin = body.rotation.transpose() * start.angular_velocity;
        before += 0.5 * body.mass * start.velocity.squaredNorm() + 0.5 * spin.dot(body.inertia_body * spin);
        with_forces += body.kinetic_energy();
    }
    return std::max(before, with_forces);
}

void hold_energy(const ContactProblem& problem, std::span<const std::uint32_t> bodies, double limit) {
    if (limit == infinity) return;
    double energy = 0.0;
    for (const std::uint32_t i : bodies) energy += problem.bodies[i].kinetic_energy();
    if (!(energy > limit)) return;
    const double scale = std::sqrt(limit / energy);
    for (const std::uint32_t i : bodies) {
        Body& body = problem.bodies[i];
        const Vec3 velocity = body.velocity + body.push_velocity, angular_velocity = body.angular_velocity + body.push_angular_velocity;
        body.momentum *= scale;
        body.angular_momentum *= scale;
        body.derive_velocities();
        body.push_velocity = velocity - body.velocity;
        body.push_angular_velocity = angular_velocity - body.angular_velocity;
    }
}

}  // namespace tumble
