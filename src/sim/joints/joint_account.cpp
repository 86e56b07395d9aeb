// The accounts of a step, by row and by joint.
#include "sim/joints/joint_account.h"

#include "sim/contact/direct/joint_rows.h"

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

double square(double x) { return x * x; }

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

double JointSet::potential(const Joint& joint, const std::vector<Body>& bodies) {
    if (!joint.active || joint.broken) return 0.0;
    bool any = false;
    for (std::size_t k = 0; k < joint.count(); ++k) any = any || joint.axis(k).spring;
    if (!any) return 0.0;
    const JointGeometry g = measure(joint, side_of(bodies, joint.a), side_of(bodies, joint.b));
    if (joint.turns_alike() && joint.axis(3).spring) return 0.5 * joint.springs[3].stiffness * g.rotation.squaredNorm();
    double sum = 0.0;
    for (std::size_t k = 0; k < joint.count(); ++k)
        if (joint.axis(k).spring)
            sum += 0.5 * joint.springs[k].stiffness * square(g.coordinates[k].value - joint.springs[k].rest);
    return sum;
}

void JointSet::start_account(const std::vector<Body>& bodies) {
    for (Joint& joint : joints_) {
        joint.account.work = {};
        joint.account.work.stored = potential(joint, bodies);
    }
}

void JointSet::begin_frame() {
    for (Joint& joint : joints_) joint.account.frame = {};
}

void JointSet::end_step() {
    for (Joint& joint : joints_) {
        JointAccount& account = joint.account;
        if (account.step.solves == 0) continue;
        joint.force = account.step.load.force / (to_ - from_);
        joint.torque = account.step.load.torque / (to_ - from_);
        account.frame.load.add(account.step.load);
        account.frame.work_a += account.step.work_a;
        account.frame.work_b += account.step.work_b;
        ++account.frame.solves;
        account.work.add(account.step.work);
        account.step = {};
        account.holds = true;
    }
}

// Joints of sleeping bodies give their last forces in the steps without a solve.
void JointSet::end_frame(int steps, double h, const std::vector<Body>& bodies) {
    for (Joint& joint : joints_) {
        JointAccount& account = joint.account;
        const auto rests = [&](std::uint32_t i) {
            return i == Joint::world || !bodies[i].dynamic() || bodies[i].asleep;
        };
        const int rest = steps - account.frame.solves;
        if (joint.active && rest > 0 && rests(joint.a) && rests(joint.b)) {
            const JointLoad last{joint.force, joint.torque, joint.point.cross(joint.force) + joint.torque};
            account.frame.load.add(last, rest * h);
        }
        account.mean = {};
        account.mean.add(account.frame.load, 1.0 / (steps * h));
    }
}

JointEnergies JointSet::energies(const std::vector<Body>& bodies) const {
    JointEnergies sum;
    for (const Joint& joint : joints_) {
        const JointWork& work = joint.account.work;
        const double elastic = potential(joint, bodies);
        sum.elastic += elastic;
        sum.motors += work.motors;
        sum.carriers += work.carriers;
        sum.heat += work.heat + (work.stored - elastic - work.springs);  // springs do not give it back
        sum.impacts += work.impacts;
    }
    return sum;
}

double JointSet::elastic(const std::vector<Body>& bodies) const {
    double sum = 0.0;
    for (const Joint& joint : joints_) sum += potential(joint, bodies);
    return sum;
}

}  // namespace tumble
