#include "sim/joints/joint_blow.h"

#include <algorithm>

namespace tumble {

double JointBlow::over(double h) const {
    if (second) return 0.0;  // a gear's strength is that of its force along the first coordinate
    const JointDescription& strength = joint->description;
    return std::max({force.norm() / strength.break_impulse, force.norm() / h / strength.break_force,
                     torque.norm() / h / strength.break_torque});
}

void take_blow(const JointBlow& blow, std::vector<Body>& bodies) {
    if (blow.force.isZero(0.0) && blow.torque.isZero(0.0)) return;
    const auto add = [&](std::uint32_t i, double sign) {
        if (i == Joint::world || !bodies[i].dynamic()) return;
        Body& body = bodies[i];
        body.momentum += sign * blow.force;
        body.angular_momentum += sign * ((blow.point - body.position).cross(blow.force) + blow.torque);
    };
    add(blow.at->a, -1.0);
    add(blow.at->b, 1.0);
    JointAccount::Span& account = blow.joint->account.events;
    (blow.second ? account.second_load : account.load)
        .add({blow.force, blow.torque, blow.point.cross(blow.force) + blow.torque});
    (blow.second ? account.second_work_a : account.work_a) += blow.work_a;
    (blow.second ? account.second_work_b : account.work_b) += blow.work_b;
    if (blow.breaks)
        account.work.heat -= blow.work_a + blow.work_b;
    else
        account.work.impacts += blow.lost;
    const auto carrier = [&](std::uint32_t i) { return i == Joint::world || !bodies[i].dynamic(); };
    if (carrier(blow.at->a)) account.work.carriers -= blow.work_a;
    if (carrier(blow.at->b)) account.work.carriers -= blow.work_b;
    if (blow.second) return;
    blow.joint->point = blow.point;
    ++account.solves;
}

void find_work(JointBlow& blow, const std::vector<Body>& bodies) {
    const auto work = [&](std::uint32_t i) {
        if (i == Joint::world) return 0.0;
        const Body& body = bodies[i];
        Vec3 velocity = body.velocity, spin = body.angular_velocity;
        if (body.dynamic()) {
            velocity = 0.5 * (velocity + body.inverse_mass * body.momentum);
            spin = 0.5 * (spin + body.inverse_inertia * body.angular_momentum);
        }
        return blow.force.dot(velocity + spin.cross(blow.point - body.position)) + blow.torque.dot(spin);
    };
    blow.work_a = -work(blow.at->a);
    blow.work_b = work(blow.at->b);
}

}  // namespace tumble
