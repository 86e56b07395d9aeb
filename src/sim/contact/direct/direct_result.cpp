// DirectSolver: transfer of the impulses and velocities found to the manifolds and bodies.
#include "sim/contact/direct/direct_solver.h"

#include <vector>

namespace tumble {

using namespace contact_rows;

void DirectSolver::store(const ContactProblem& problem, std::span<const std::uint32_t> bodies, bool pushed) {
    std::vector<bool> reached(bodies.size(), pushed);  // by impulses or a push
    for (const Patch& patch : patches_) {
        Manifold& m = problem.manifolds[patch.manifold];
        Body &a = problem.bodies[m.a], &b = problem.bodies[m.b];
        const ContactConstraint& geometry = patch.geometry;
        release(m);
        m.friction[0] = patch.friction[0].impulse;
        m.friction[1] = patch.friction[1].impulse;
        m.twist = patch.count > 1 ? patch.twist.impulse : 0.0;
        m.tangent = geometry.tangent_1;
        const Vec3 friction = m.friction[0] * geometry.tangent_1 + m.friction[1] * geometry.tangent_2;
        Vec3 force = friction,
             moment = geometry.friction_arm_a.cross(friction) + m.twist * geometry.normal;  // about A's center
        for (int i = 0; i < patch.count; ++i) {
            const ContactConstraint::Point& p = geometry.points[std::size_t(i)];
            m.points[std::size_t(p.source)].impulse = patch.normal[i].impulse;
            const Vec3 j = patch.normal[i].impulse * geometry.normal;
            force += j;
            moment += p.arm_a.cross(j);
        }
        if (force.isZero(0.0) && moment.isZero(0.0)) continue;
        if (patch.a != none) {
            reached[std::size_t(patch.a)] = true;
            a.momentum -= force;
            a.angular_momentum -= moment;
        }
        if (patch.b != none) {
            reached[std::size_t(patch.b)] = true;
            b.momentum += force;
            b.angular_momentum += moment + (a.position - b.position).cross(force);
        }
    }
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        if (!reached[k]) continue;
        Body& body = problem.bodies[bodies[k]];
        body.derive_velocities();
        if (!pushed && way_.empty()) continue;
        body.push_velocity = Vec3::Map(push_.data() + 6 * k);
        body.push_angular_velocity = Vec3::Map(push_.data() + 6 * k + 3) / length_;
        if (way_.empty()) continue;
        const double rate = 1.0 / problem.patches.h;
        body.push_velocity += rate * Vec3::Map(way_.data() + 6 * k) - body.velocity;
        body.push_angular_velocity +=
            rate / length_ * Vec3::Map(way_.data() + 6 * k + 3) - body.angular_velocity - body.gyration;
    }
}

}  // namespace tumble
