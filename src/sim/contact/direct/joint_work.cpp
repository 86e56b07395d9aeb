// JointRows: the work of a step by row, the impulses of its joints, and the swing of its bodies under them.
#include "sim/contact/direct/joint_rows.h"
#include "sim/joints/pendulum_rate.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Kinetic energy changes by an impulse times the mean of the velocities before and after.
BodyVelocity mean_of(const BodyVelocity& before, const Body& after) {
    return {0.5 * (before.velocity + after.velocity), 0.5 * (before.angular_velocity + after.angular_velocity)};
}

void add_work(JointWork& work, Joint::Law law, double done, bool catches) {
    switch (law) {
        case Joint::lock:
            if (catches) work.impacts -= done;  // otherwise zero but for the integrator's error
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

// Velocity of the body at a point: the mean of before and after the step.
BodyVelocity JointRows::mean_velocity(const JointIsland& island, std::uint32_t body, int place,
                                      const Vec3& point) const {
    if (body == Joint::world) return {Vec3::Zero(), Vec3::Zero()};
    const Body& b = island.problem.bodies[body];
    const BodyVelocity of =
        place == none ? BodyVelocity{b.velocity, b.angular_velocity} : mean_of(before_[std::size_t(place)], b);
    const Vec3 center = place == none ? side_at(island, body).position : b.position;
    return {of.velocity + of.angular_velocity.cross(point - center), of.angular_velocity};
}

void JointRows::account(const JointIsland& island, Booking booking) {
    for (const Block& block : blocks_) {
        Joint& j = joint(block);
        JointAccount::Span& step = booking == Booking::stop ? j.account.events : j.account.step;
        const bool catches = booking == Booking::stop || !j.account.holds;
        if (block.gear) {
            account_gear(island, block, catches, step);
            continue;
        }
        const BodyVelocity a = mean_velocity(island, j.a, block.a, block.point),
                           b = mean_velocity(island, j.b, block.b, block.point);
        const Vec3 apart = b.velocity - a.velocity, turning = b.angular_velocity - a.angular_velocity;
        for (std::size_t k = block.first; k < block.first + block.count; ++k) {
            const Row& row = rows_[k];
            const Vec3 impulse = (row.turns() ? length_ : 1.0) * row.impulse * row.direction;
            const double done = impulse.dot(row.turns() ? turning : apart);
            if (block.breaks)
                step.work.heat -= done;
            else
                add_work(step.work, row.law, done, catches);
        }
        const JointReaction reaction = reaction_of(block);
        step.reaction.add(reaction);
        const double on_a = -(reaction.force.dot(a.velocity) + reaction.torque.dot(a.angular_velocity));
        const double on_b = reaction.force.dot(b.velocity) + reaction.torque.dot(b.angular_velocity);
        step.work_a += on_a;
        step.work_b += on_b;
        if (block.a == none) step.work.carriers -= on_a;
        if (block.b == none) step.work.carriers -= on_b;
        ++step.solves;
    }
}

double JointRows::pendulum_rate(const JointIsland& island) {
    pendulum_rates_.assign(island.bodies.size(), 0.0);
    double most = 0.0;
    for (const Block& block : blocks_) {
        Vec3 force = Vec3::Zero();
        for (std::size_t k = block.first; k < block.first + block.count; ++k)
            if (!rows_[k].turns()) force += rows_[k].impulse / h_ * rows_[k].direction;
        const Joint& j = joint(block);
        for (const auto& [body, place] : {std::pair(j.a, block.a), std::pair(j.b, block.b)}) {
            if (place == none) continue;
            const Body& b = island.problem.bodies[body];
            double& sum = pendulum_rates_[std::size_t(place)];
            sum += force.norm() * pendulum_compliance(block.axes, block.point - b.position, b.inverse_inertia);
            most = std::max(most, sum);
        }
    }
    return std::sqrt(most);
}

}  // namespace tumble
