#include "sim/articulation/tree_account.h"

#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {

void TreeAccount::begin(const TreeStep& step) {
    step_ = &step;
    const std::size_t n = step.island.size(), m = step.joints.size();
    starts_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Body& body = step.bodies[step.island[i]];
        starts_[i] = {body.position, body.momentum, body.angular_momentum, body.kinetic_energy()};
    }
    rotors_.resize(m);
    for (std::size_t k = 0; k < m; ++k) rotors_[k] = JointSet::rotor_energy(*step.joints[k], step.bodies);
    samples_.resize(m);
    moments_.assign(m, Vec3::Zero());
    carried_.assign(m, Vec3::Zero());
    torques_.assign(m, Vec3::Zero());
    struck_.clear();
    momenta_.resize(n);
    pushes_.assign(n, Vec3::Zero());
    forces_.resize(tree_.nodes().size());
    time_ = 0.0;
    sampled_ = staged_ = false;
    carrier_ = Joint::world;
}

// The force on the joint's second body, about that body's anchor.
TreeAccount::Sample TreeAccount::joint_sample(const ForwardDynamics& dynamics, int index, double t) const {
    const Joint& joint = *step_->joints[std::size_t(index)];
    const int place = tree_.child_of(index), node = tree_.node_of_body()[std::size_t(place)];
    const bool second = joint.b == step_->island[std::size_t(place)];
    const ForwardDynamics::Link& link = dynamics.link(node);
    const SpatialForce& on_child = forces_[std::size_t(node)];
    Sample s;
    if (second) {
        s = {on_child.force, on_child.moment, link.point, link.velocity.move};
    } else {
        const ForwardDynamics::Link& ground = dynamics.link(tree_.anchor_node(index));
        s.point = ground.point;
        s.rate = ground.velocity.move;
        if (const int above = tree_.parent_of(index); above != TreeNode::no_body) {
            const int at = tree_.node_of_body()[std::size_t(above)];
            const ForwardDynamics::Link& parent = dynamics.link(at);
            const Vec3 anchor = parent.rotation * joint.anchor_b;
            s.point = parent.position() + anchor;
            s.rate = parent.center_velocity() + parent.velocity.turn.cross(anchor);
        }
        s.force = -on_child.force;
        s.torque = -(on_child.moment + (link.point - s.point).cross(on_child.force));
    }
    if (!tree_.is_free()) {
        s.point -= 0.5 * t * t * frame_.gravity;
        s.rate -= t * frame_.gravity;
    }
    return s;
}

// Integrals of p x F from the last sample to this one, by Simpson's rule: the force in the middle is that which gives
// the mean, and the point there follows from both ends and their rates.
void TreeAccount::add_mean_forces(std::span<const Vec3> momenta, std::span<const Vec3> applied,
                                  std::span<const Sample> ends, double t) {
    const double span = t - time_;
    std::vector<Vec3> impulses(momenta.size());  // of the joint that each body hangs on
    for (std::size_t i = 0; i < momenta.size(); ++i) impulses[i] = momenta[i] - momenta_[i] - (applied[i] - pushes_[i]);
    const auto order = tree_.order();
    for (std::size_t k = order.size(); k-- > 0;) {
        const auto [body, index] = order[k];
        if (index == TreeNode::no_joint) continue;
        const Vec3 behind = impulses[std::size_t(body)];
        if (const int above = tree_.parent_of(index); above != TreeNode::no_body)
            impulses[std::size_t(above)] += behind;
        const std::size_t j = std::size_t(index);
        const bool second = step_->joints[j]->b == step_->island[std::size_t(body)];
        const Sample &a = samples_[j], &b = ends[j];
        const Vec3 mean = (second ? 1.0 : -1.0) / span * behind;
        const Vec3 middle = 0.25 * (6.0 * mean - a.force - b.force);
        const Vec3 point = 0.5 * (a.point + b.point) + 0.125 * span * (a.rate - b.rate);
        const double third = span / 6.0;
        moments_[j] += third * (a.point.cross(a.force) + 4.0 * point.cross(middle) + b.point.cross(b.force));
        carried_[j] += third * (frame_.place(time_).cross(a.force) +
                                4.0 * frame_.place(0.5 * (time_ + t)).cross(middle) + frame_.place(t).cross(b.force));
    }
}

void TreeAccount::strike(const ForwardDynamics& dynamics, double t, std::span<const Wrench> impulses) {
    dynamics.joint_forces(impulses, forces_);
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        if (!tree_.hangs(int(k))) continue;
        const Sample s = joint_sample(dynamics, int(k), t);
        if (!struck_.empty()) struck_[k] += s.force;
        moments_[k] += s.point.cross(s.force);
        carried_[k] += frame_.place(t).cross(s.force);
        torques_[k] += s.torque;
    }
}

void TreeAccount::add_stage(const ForwardDynamics& dynamics, double t, double h) {
    const Vec3 place = frame_.place(t);
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        if (!tree_.hangs(int(k))) continue;
        const std::size_t node = std::size_t(tree_.node_of_body()[std::size_t(tree_.child_of(int(k)))]);
        forces_[node] = dynamics.joint_force(int(node));
        samples_[k] = joint_sample(dynamics, int(k), t);
        torques_[k] += h * samples_[k].torque;
        carried_[k] += h * place.cross(samples_[k].force);
    }
    staged_ = true;
}

void TreeAccount::sample(const ForwardDynamics& dynamics, double t, std::span<const Wrench> wrenches,
                         std::span<const AppliedImpulse> pushed) {
    dynamics.joint_forces(wrenches, forces_);
    std::vector<Sample> now(samples_.size());
    for (std::size_t k = 0; k < now.size(); ++k)
        if (tree_.hangs(int(k))) now[k] = joint_sample(dynamics, int(k), t);
    std::vector<Vec3> momenta(starts_.size()), given(starts_.size(), Vec3::Zero());
    for (std::size_t i = 0; i < momenta.size(); ++i) {
        const int node = tree_.node_of_body()[i];
        Vec3 velocity = dynamics.link(node).center_velocity();
        if (!tree_.is_free()) velocity -= t * frame_.gravity;
        momenta[i] = tree_.nodes()[std::size_t(node)].mass * velocity;
        if (!pushed.empty()) given[i] = pushed[i].impulse;
    }
    if (sampled_ && t > time_) add_mean_forces(momenta, given, now, t);
    samples_.swap(now);
    momenta_.swap(momenta);
    pushes_.swap(given);
    time_ = t;
    sampled_ = true;
}

double TreeAccount::load_of(const ForwardDynamics& dynamics, int joint, std::span<const Wrench> wrenches) {
    dynamics.joint_forces(wrenches, forces_);
    const Sample s = joint_sample(dynamics, joint, 0.0);
    const JointDescription& strength = step_->joints[std::size_t(joint)]->description;
    return std::max(s.force.norm() / strength.break_force, s.torque.norm() / strength.break_torque);
}

// As for the rows of the direct solver (JointRows::pendulum_rate): sqrt(4 T / (m l)) for a rod of length l.
double TreeAccount::pendulum_rate(double h) {
    for (std::size_t k = 0; k < samples_.size(); ++k) samples_[k].force += struck_[k] / h;
    return pendulum_rate();
}

double TreeAccount::pendulum_rate() {
    double most = 0.0;
    sums_.assign(starts_.size(), 0.0);
    for (std::size_t k = 0; k < samples_.size(); ++k) {
        if (!tree_.hangs(int(k))) continue;
        const double load = samples_[k].force.norm() / 3.0;
        for (const int side : {0, 1}) {
            const int place = side == 0 ? tree_.child_of(int(k)) : tree_.parent_of(int(k));
            if (place == TreeNode::no_body) continue;
            double& sum = sums_[std::size_t(place)];
            sum += load * tree_.lever_of(int(k), side);
            most = std::max(most, sum);
        }
    }
    return std::sqrt(most);
}

bool TreeAccount::finish(std::span<const AppliedImpulse> pushed) {
    const double h = step_->h;
    behind_.assign(starts_.size(), {});
    for (std::size_t i = 0; i < starts_.size(); ++i) {
        const Body& body = step_->bodies[step_->island[i]];
        const Start& start = starts_[i];
        const Vec3 before = start.momentum - body.mass * frame_.velocity;
        const Vec3 after = body.momentum - body.mass * frame_.speed(h);
        Behind& b = behind_[i];
        b.momentum = after - before;
        b.moment = body.angular_momentum - start.angular_momentum + (body.position - frame_.place(h)).cross(after) -
                   (start.position - frame_.origin).cross(before);
        b.work = body.kinetic_energy() - start.energy - body.mass * frame_.gravity.dot(body.position - start.position);
        if (pushed.empty()) continue;
        b.momentum -= pushed[i].impulse;
        b.moment -= pushed[i].moment;
        b.work -= pushed[i].work;
    }
    const auto order = tree_.order();
    for (std::size_t k = order.size(); k-- > 0;) {
        const auto [body, index] = order[k];
        if (index == TreeNode::no_joint) continue;
        const Behind& b = behind_[std::size_t(body)];
        if (const int above = tree_.parent_of(index); above != TreeNode::no_body) {
            Behind& next = behind_[std::size_t(above)];
            next.momentum += b.momentum;
            next.moment += b.moment;
        }
        if (!settle(*step_->joints[std::size_t(index)], index, b)) return false;
    }
    return true;
}

// A joint gives its first body the work of its laws, less that which it gives to the bodies behind it.
void TreeAccount::give_work() {
    const auto order = tree_.order();
    for (std::size_t k = order.size(); k-- > 0;) {
        const auto [body, index] = order[k];
        if (index == TreeNode::no_joint) continue;
        Joint& joint = *step_->joints[std::size_t(index)];
        JointAccount::Span& step = joint.account.step;
        const double behind = behind_[std::size_t(body)].work,
                     before = step.work.springs + step.work.motors - step.work.heat - step.work.impacts - behind;
        const bool second = joint.b == step_->island[std::size_t(body)];
        (second ? step.work_b : step.work_a) = behind;
        double& other = second ? step.work_a : step.work_b;
        if (const int above = tree_.parent_of(index); above != TreeNode::no_body) {
            behind_[std::size_t(above)].work -= before;
            other = before;
        } else if (carrier_ != Joint::world) {
            step.work.carriers = -before;
            other = before;
        }
    }
}

// At the end of the step.
JointSide TreeAccount::side(std::uint32_t body) const {
    return body == carrier_ ? carrier_end_ : side_of(step_->bodies, body);
}

bool TreeAccount::settle(Joint& joint, int index, const Behind& behind) const {
    const std::size_t k = std::size_t(index);
    const bool second = joint.b == step_->island[std::size_t(tree_.child_of(index))];
    const double sign = second ? 1.0 : -1.0, h = step_->h;
    JointReaction reaction;
    reaction.force = sign * behind.momentum;
    reaction.torque = staged_ ? torques_[k] : Vec3(sign * behind.moment - moments_[k]);
    reaction.moment = sign * behind.moment + carried_[k];
    joint.force = reaction.force / h;
    joint.torque = reaction.torque / h;
    if (staged_) {  // the force stands for them
        joint.impulse = {};
        joint.curving = {};
    }
    // Otherwise the caller has counted the way of the coordinate.
    if (!staged_ || joint.soft || !tree_.plain(index)) {
        const JointGeometry g = measure(joint, side(joint.a), side(joint.b));
        for (std::size_t c = 0; c < joint.count(); ++c)
            if (!joint.locked(c)) joint.value[c] = g.coordinates[c].value;
        if (beyond_limit(joint, g, staged_ ? 0.0 : tuning::joint_rounding)) return false;
        joint.point = g.point;
        if (!staged_) keep_impulses(joint, g, samples_[k]);
    } else {
        if (joint.turns_alike()) joint.value[3] = twist_of(joint, side(joint.a), side(joint.b));
        joint.point = joint.anchor_b;
        if (joint.b != Joint::world) {
            const JointSide b = side(joint.b);
            joint.point = b.position + b.orientation * joint.anchor_b;
        }
    }
    const JointDescription& strength = joint.description;
    const double over =
        std::max({joint.force.norm() / strength.break_force, reaction.force.norm() / strength.break_impulse,
                  joint.torque.norm() / strength.break_torque});
    if (over > tuning::joint_flight_over) return false;
    if (over > 1.0) {
        joint.broken = true;
        joint.broken_at = step_->from + h;
    }
    joint.account.step = {};
    joint.account.step.add_flight(reaction, 0.0, 0.0);
    joint.account.step.work.springs = rotors_[k] - JointSet::rotor_energy(joint, step_->bodies);
    return true;
}

// The forces at the end, as the first estimate of the rows.
void TreeAccount::keep_impulses(Joint& joint, const JointGeometry& g, const Sample& end) const {
    joint.impulse = {};
    joint.curving = {};
    for (std::size_t c = 0; c < joint.count(); ++c) {
        if (!joint.locked(c)) continue;
        const double force = g.coordinates[c].direction.dot(c < 3 ? end.force : end.torque);
        joint.impulse[c][Joint::lock] = force * step_->h;
    }
}

}  // namespace tumble
