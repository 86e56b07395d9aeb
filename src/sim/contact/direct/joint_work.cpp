// JointRows: the work of a step, by row, and the impulses of its joints.
#include "sim/contact/direct/joint_rows.h"

namespace tumble {
namespace {

// Kinetic energy changes by an impulse times the mean of the velocities before and after.
BodyVelocity mean_of(const BodyVelocity& before, const Body& after) {
    return {0.5 * (before.velocity + after.velocity), 0.5 * (before.angular_velocity + after.angular_velocity)};
}

void add_work(JointWork& work, Joint::Law law, double done, bool catches) {
    switch (law) {
        case Joint::lock:
            if (catches) work.impacts -= done;  // else zero but for the integrator's error
            break;
        case Joint::lower:
        case Joint::upper:
        case Joint::cone:
            work.impacts -= done;
            break;
        case Joint::spring:
            work.springs += done;
            break;
        case Joint::motor:
            work.motors += done;
            break;
        case Joint::friction:
            work.heat -= done;
            break;
    }
}

}  // namespace

void JointRows::keep_velocities(const JointIsland& island, bool first) {
    before_.clear();
    for (const std::uint32_t i : island.bodies) {
        const Body& body = island.problem.bodies[i];
        before_.push_back(first ? island.problem.before[i] : BodyVelocity{body.velocity, body.angular_velocity});
    }
}

void JointRows::account(const JointIsland& island) {
    const std::vector<Body>& bodies = island.problem.bodies;
    const bool first = from_ == island.problem.joints->from();
    for (const Block& block : blocks_) {
        Joint& j = joint(block);
        JointAccount::Span& step = j.account.step;
        if (first) step = {};
        const auto velocity = [&](std::uint32_t body, int place) -> BodyVelocity {
            if (body == Joint::world) return {Vec3::Zero(), Vec3::Zero()};
            const Body& b = bodies[body];
            const BodyVelocity of =
                place == none ? BodyVelocity{b.velocity, b.angular_velocity} : mean_of(before_[std::size_t(place)], b);
            return {of.velocity + of.angular_velocity.cross(block.point - b.position), of.angular_velocity};
        };
        const BodyVelocity a = velocity(j.a, block.a), b = velocity(j.b, block.b);
        const Vec3 apart = b.velocity - a.velocity, turning = b.angular_velocity - a.angular_velocity;
        JointLoad load;
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            const Vec3 impulse = (row.turns() ? length_ : 1.0) * row.impulse * row.direction;
            (row.turns() ? load.torque : load.force) += impulse;
            const double done = impulse.dot(row.turns() ? turning : apart);
            if (block.breaks)
                step.work.heat -= done;
            else
                add_work(step.work, row.law, done, !j.account.holds);
        }
        load.moment = block.point.cross(load.force) + load.torque;
        step.load.add(load);
        const double on_a = -(load.force.dot(a.velocity) + load.torque.dot(a.angular_velocity));
        const double on_b = load.force.dot(b.velocity) + load.torque.dot(b.angular_velocity);
        step.work_a += on_a;
        step.work_b += on_b;
        if (block.a == none) step.work.carriers -= on_a;
        if (block.b == none) step.work.carriers -= on_b;
        ++step.solves;
    }
}

}  // namespace tumble
