#include "sim/contact/energy_limit.h"

#include "sim/tuning.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// v . P + omega . L of a body for two of its motions: twice the energy, if they are the same.
double product(const Body& body, const BodyVelocity& a, const BodyVelocity& b) {
    const Vec3 spin_a = body.rotation.transpose() * a.angular_velocity, spin_b = body.rotation.transpose() * b.angular_velocity;
    return body.mass * a.velocity.dot(b.velocity) + spin_a.dot(body.inertia_body * spin_b);
}

// So thin that a sweep which stops short may spin it up from rest.
bool slender(const Body& body) {
    const Vec3 moments = body.inertia_body.diagonal();
    return moments.maxCoeff() > tuning::soft_energy_slender * moments.minCoeff();
}

}  // namespace

EnergyLimit energy_limit(const ContactProblem& problem, std::span<const std::uint32_t> bodies, std::span<const std::uint32_t> manifolds) {
    if (bodies.size() > tuning::soft_energy_bodies) return {};
    const double fast = tuning::soft_energy_turn * substeps_of(problem.patches.h) / problem.patches.h;
    const auto may_gain = [&](std::uint32_t i) {
        return problem.bodies[i].angular_velocity.squaredNorm() > fast * fast || slender(problem.bodies[i]);
    };
    if (std::none_of(bodies.begin(), bodies.end(), may_gain)) return {};
    bool leans = false;
    for (const std::uint32_t k : manifolds)
        for (const std::uint32_t i : {problem.manifolds[k].a, problem.manifolds[k].b}) {
            const Body& body = problem.bodies[i];
            if (!body.dynamic() && body.moves()) return {};
            leans = leans || !body.dynamic();
        }
    if (!leans) return {};
    EnergyLimit limit;
    for (const std::uint32_t i : bodies) {
        const Body& body = problem.bodies[i];
        const BodyVelocity& start = problem.before[i];
        limit.start += 0.5 * product(body, start, start);
        limit.with_forces += body.kinetic_energy();
        limit.forces.push_back({body.velocity - start.velocity, body.angular_velocity - start.angular_velocity});
    }
    return limit;
}

void hold_energy(const ContactProblem& problem, std::span<const std::uint32_t> bodies, const EnergyLimit& limit) {
    if (limit.forces.empty()) return;
    double energy = 0.0, work = 0.0;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        const Body& body = problem.bodies[bodies[k]];
        energy += body.kinetic_energy();
        // The forces' impulse P = F h on the way h (v + push): work P . (v + push); and so for the turn.
        work += product(body, limit.forces[k], {body.velocity + body.push_velocity, body.angular_velocity + body.push_angular_velocity});
    }
    const double most = std::max(0.0, std::min(std::max(limit.start, limit.with_forces), limit.start + work));
    if (!(energy > most)) return;
    const double scale = std::sqrt(most / energy), share = limit.start + work < 0.0 ? limit.start / -work : 1.0;
    for (const std::uint32_t i : bodies) {
        Body& body = problem.bodies[i];
        const Vec3 velocity = share * (body.velocity + body.push_velocity);
        const Vec3 angular_velocity = share * (body.angular_velocity + body.push_angular_velocity);
        body.momentum *= scale;
        body.angular_momentum *= scale;
        body.derive_velocities();
        body.push_velocity = velocity - body.velocity;
        body.push_angular_velocity = angular_velocity - body.angular_velocity;
    }
}

}  // namespace tumble
