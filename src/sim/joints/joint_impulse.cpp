#include "sim/joints/joint_impulse.h"

#include "sim/joints/joint_set.h"

#include <algorithm>

namespace tumble {

double JointImpulse::over(double h) const {
    if (second) return 0.0;  // a gear's strength is that of its force along the first coordinate
    const JointDescription& strength = joint->description;
    return std::max({force.norm() / strength.break_impulse, force.norm() / h / strength.break_force,
                     torque.norm() / h / strength.break_torque});
}

void apply_joint_impulse(const JointImpulse& impulse, std::vector<Body>& bodies) {
    if (impulse.force.isZero(0.0) && impulse.torque.isZero(0.0)) return;
    const auto add = [&](std::uint32_t i, double sign) {
        if (i == Joint::world || !bodies[i].dynamic()) return;
        Body& body = bodies[i];
        body.momentum += sign * impulse.force;
        body.angular_momentum += sign * ((impulse.point - body.position).cross(impulse.force) + impulse.torque);
    };
    add(impulse.at->a, -1.0);
    add(impulse.at->b, 1.0);
    JointAccount::Span& account = impulse.joint->account.events;
    (impulse.second ? account.second_reaction : account.reaction)
        .add({impulse.force, impulse.torque, impulse.point.cross(impulse.force) + impulse.torque});
    (impulse.second ? account.second_work_a : account.work_a) += impulse.work_a;
    (impulse.second ? account.second_work_b : account.work_b) += impulse.work_b;
    if (impulse.breaks)
        account.work.heat -= impulse.work_a + impulse.work_b;
    else
        account.work.impacts += impulse.lost;
    account.work.springs -= impulse.rotor;
    const auto carrier = [&](std::uint32_t i) { return i == Joint::world || !bodies[i].dynamic(); };
    if (carrier(impulse.at->a)) account.work.carriers -= impulse.work_a;
    if (carrier(impulse.at->b)) account.work.carriers -= impulse.work_b;
    if (impulse.second) return;
    impulse.joint->point = impulse.point;
    ++account.solves;
}

void find_work(JointImpulse& impulse, const std::vector<Body>& bodies) {
    const auto work = [&](std::uint32_t i) {
        if (i == Joint::world) return 0.0;
        const Body& body = bodies[i];
        Vec3 velocity = body.velocity, spin = body.angular_velocity;
        if (body.dynamic()) {
            velocity = 0.5 * (velocity + body.inverse_mass * body.momentum);
            spin = 0.5 * (spin + body.inverse_inertia * body.angular_momentum);
        }
        return impulse.force.dot(velocity + spin.cross(impulse.point - body.position)) + impulse.torque.dot(spin);
    };
    if (const auto armature = impulse.joint->description.armature) {
        const double before = rotor_speed(*impulse.joint, bodies, RotorTime::before_impact),
                     after = rotor_speed(*impulse.joint, bodies);
        impulse.rotor = 0.5 * *armature * (after - before) * (after + before);
    }
    impulse.work_a = -work(impulse.at->a);
    impulse.work_b = work(impulse.at->b);
}

}  // namespace tumble
