// JointSet: the accounts of a frame.
#include "sim/joints/joint_account.h"

#include "core/fetch_ahead.h"
#include "sim/joints/joint_set.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

double square(double x) { return x * x; }

// Only gears have the second part: most joints spare the memory.
void clear_span(const Joint& joint, JointAccount::Span& span) {
    span.reaction = {};
    span.work_a = span.work_b = 0.0;
    span.work = {};
    span.solves = 0;
    if (!joint.gear()) return;
    span.second_reaction = {};
    span.second_work_a = span.second_work_b = 0.0;
}

void add_span(const Joint& joint, const JointAccount::Span& from, JointAccount::Span& to) {
    to.reaction.add(from.reaction);
    to.work_a += from.work_a;
    to.work_b += from.work_b;
    if (!joint.gear()) return;
    to.second_reaction.add(from.second_reaction);
    to.second_work_a += from.second_work_a;
    to.second_work_b += from.second_work_b;
}

}  // namespace

double JointSet::rotor_energy(const Joint& joint, const std::vector<Body>& bodies) {
    if (!joint.description.armature || !joint.active || joint.broken) return 0.0;
    return 0.5 * *joint.description.armature * square(rotor_speed(joint, bodies));
}

double JointSet::rotor_energy(const std::vector<Body>& bodies) const {
    double sum = 0.0;
    for (const Joint& joint : joints_) sum += rotor_energy(joint, bodies);
    return sum;
}

// The energy that a joint can give back: of springs and armature.
double JointSet::stored(const Joint& joint, const std::vector<Body>& bodies) {
    return potential(joint, bodies) + rotor_energy(joint, bodies);
}

double JointSet::potential(const Joint& joint, const std::vector<Body>& bodies) {
    if (!joint.active || joint.broken) return 0.0;
    bool any = false;
    for (std::size_t k = 0; joint.soft && k < joint.count(); ++k) any = any || joint.axis(k).spring;
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
        joint.account.work.stored = stored(joint, bodies);
    }
}

void JointSet::begin_frame() {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        fetch_spans(k);
        clear_span(joints_[k], joints_[k].account.frame);
    }
}

// Prefetches the account of a later joint.
void JointSet::fetch_spans(std::size_t k) const {
    if (k + elements_ahead >= joints_.size()) return;
    const JointAccount& account = joints_[k + elements_ahead].account;
    fetch_ahead(&account.step, &account.events);
}

void JointSet::end_step() {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        fetch_spans(k);
        Joint& joint = joints_[k];
        JointAccount& account = joint.account;
        if (account.step.solves == 0) continue;
        joint.force = account.step.reaction.force / (to_ - from_);
        joint.torque = account.step.reaction.torque / (to_ - from_);
        if (joint.gear()) {
            account.second = {};
            account.second.add(account.step.second_reaction, 1.0 / (to_ - from_));
        }
        add_span(joint, account.step, account.frame);
        ++account.frame.solves;
        account.work.add(account.step.work);
        clear_span(joint, account.step);
        account.holds = true;
    }
}

void JointSet::take_events() {
    for (Joint& joint : joints_) {
        JointAccount& account = joint.account;
        if (account.events.solves == 0) continue;
        joint.force += account.events.reaction.force / (to_ - from_);
        joint.torque += account.events.reaction.torque / (to_ - from_);
        if (joint.gear()) account.second.add(account.events.second_reaction, 1.0 / (to_ - from_));
        add_span(joint, account.events, account.frame);
        account.work.add(account.events.work);
        clear_span(joint, account.events);
    }
}

// Joints of sleeping bodies give their last forces in the steps without a solve.
void JointSet::end_frame(int steps, double h, const std::vector<Body>& bodies) {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
        fetch_spans(k);
        Joint& joint = joints_[k];
        JointAccount& account = joint.account;
        const auto rests = [&](std::uint32_t i) {
            return i == Joint::world || !bodies[i].dynamic() || bodies[i].asleep;
        };
        const int rest = steps - account.frame.solves;
        if (joint.active && rest > 0 && rests(joint.a) && rests(joint.b)) {
            const JointReaction last{joint.force, joint.torque, joint.point.cross(joint.force) + joint.torque};
            account.frame.reaction.add(last, rest * h);
            if (joint.gear()) account.frame.second_reaction.add(account.second, rest * h);
        }
        account.mean = {};
        account.mean.add(account.frame.reaction, 1.0 / (steps * h));
    }
}

JointEnergies JointSet::energies(const std::vector<Body>& bodies) const {
    JointEnergies sum;
    for (const Joint& joint : joints_) {
        const JointWork& work = joint.account.work;
        const double elastic = potential(joint, bodies), rotor = rotor_energy(joint, bodies);
        sum.elastic += elastic;
        sum.motors += work.motors;
        sum.carriers += work.carriers;
        sum.heat += work.heat + (work.stored - elastic - rotor - work.springs);  // not given back
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
