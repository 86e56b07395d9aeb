// TreeClosures: the forces of cut joints on the bodies, their sums over a step, and the accounts of the joints.
#include "sim/articulation/tree_closures.h"
#include "sim/joints/gear.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {

void TreeClosures::give(const std::vector<double>& l, bool springs) {
    for (Part& part : parts_) {
        if (part.spring && springs) continue;
        part.force.setZero();
        part.torque.setZero();
        part.heat = 0.0;
    }
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const Row& row = rows_[r];
        Part& part = parts_[std::size_t(row.part)];
        if (!part.gear) {
            (row.turns ? part.torque : part.force) += row.unit * l[r] * row.direction;
            continue;
        }
        for (int s = 0; s < 2; ++s) {
            Part& of = parts_[std::size_t(row.part + s)];
            (of.turns ? of.torque : of.force) = row.unit * of.factor * l[r] * of.axis;
        }
    }
}

// Equal and opposite at one point.
void TreeClosures::apply(ForwardDynamics& dynamics) const {
    for (const Part& part : parts_) {
        if (part.spring) continue;
        for (const Side* side : {&part.a, &part.b}) {
            if (side->node == TreeNode::ground) continue;
            const double sign = side == &part.b ? 1.0 : -1.0;
            const Vec3 arm = part.b.point - dynamics.link(side->node).position();
            dynamics.apply(side->node, {sign * part.force, sign * (arm.cross(part.force) + part.torque)});
        }
    }
}

void TreeClosures::add_to(const ForwardDynamics& dynamics, std::span<Wrench> wrenches) const {
    for (const Part& part : parts_)
        for (const Side* side : {&part.a, &part.b}) {
            if (side->node == TreeNode::ground) continue;
            const double sign = side == &part.b ? 1.0 : -1.0;
            const Vec3 arm = part.b.point - dynamics.link(side->node).position();
            Wrench& to = wrenches[std::size_t(side->body)];
            to.force += sign * part.force;
            to.torque += sign * (arm.cross(part.force) + part.torque);
        }
}

void TreeClosures::add_sums(const ForwardDynamics& dynamics, const FallingFrame& frame, double t, double h,
                            double* to) const {
    const bool free = tree_->is_free();
    const Vec3 place = frame.place(t), origin = free ? place : tree_->origin();
    const Vec3 speed = free ? frame.speed(t) : Vec3(Vec3::Zero());
    for (const Part& part : parts_) {
        const Vec3 moment = (origin + part.b.point).cross(part.force) + part.torque, carried = place.cross(part.force);
        for (int k = 0; k < 3; ++k) {
            to[k] += h * part.force[k];
            to[3 + k] += h * part.torque[k];
            to[6 + k] += h * moment[k];
            to[9 + k] += h * carried[k];
        }
        for (int s = 0; s < 2; ++s) {
            const Side& side = s == 0 ? part.a : part.b;
            if (side.node == TreeNode::ground) continue;
            const ForwardDynamics::Link& link = dynamics.link(side.node);
            const Vec3 velocity = link.velocity.move + link.velocity.turn.cross(part.b.point - link.point) + speed;
            to[12 + s] += (s == 0 ? -h : h) * (part.force.dot(velocity) + part.torque.dot(link.velocity.turn));
        }
        to[14] += h * part.heat;
        to += sums;
    }
}

void TreeClosures::add_impulses(const double* from, std::vector<AppliedImpulse>& list) const {
    for (const Part& part : parts_) {
        const Vec3 impulse = Vec3::Map(from), moment = Vec3::Map(from + 6) - Vec3::Map(from + 9);
        for (int s = 0; s < 2; ++s) {
            const Side& side = s == 0 ? part.a : part.b;
            if (side.body == TreeNode::no_body) continue;
            AppliedImpulse& to = list[std::size_t(side.body)];
            to.impulse += s == 0 ? Vec3(-impulse) : impulse;
            to.moment += s == 0 ? Vec3(-moment) : moment;
            to.work += from[12 + s];
        }
        from += sums;
    }
}

double TreeClosures::load_of(int joint) const {
    const auto part = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return p.joint == joint; });
    const JointDescription& strength = joints_[std::size_t(joint)]->description;
    return std::max(part->force.norm() / strength.break_force, part->torque.norm() / strength.break_torque);
}

bool TreeClosures::finish(const TreeStep& step, const double* from) const {
    for (std::size_t p = 0; p < parts_.size(); ++p, from += sums) {
        const Part& part = parts_[p];
        Joint& joint = *step.joints[std::size_t(part.joint)];
        const JointReaction reaction{Vec3::Map(from), Vec3::Map(from + 3), Vec3::Map(from + 6)};
        JointAccount::Span& span = joint.account.step;
        if (part.second) {
            span.second_reaction.add(reaction);
            span.second_work_a += from[12];
            span.second_work_b += from[13];
            continue;
        }
        span = {};
        span.add_flight(reaction, from[12], from[13]);
        if (part.spring) span.work.springs = part.stored - JointSet::potential(joint, step.bodies) - from[14];
        joint.force = reaction.force / step.h;
        joint.torque = reaction.torque / step.h;
        joint.impulse = {};
        joint.curving = {};
        const Joint& of = part.gear ? *step.joints[std::size_t(part.of)] : joint;
        const JointGeometry g = measure(of, side_of(step.bodies, of.a), side_of(step.bodies, of.b));
        joint.point = g.point;
        const auto along = [&](std::size_t c) {
            return g.coordinates[c].direction.dot(c < 3 ? reaction.force : reaction.torque);
        };
        if (part.gear) {
            const std::size_t c = geared_coordinate(of);
            joint.impulse[c][Joint::lock] = along(c);
        } else {
            if (beyond_limit(joint, g)) return false;
            for (std::size_t c = 0; c < joint.count(); ++c) {
                if (joint.locked(c))
                    joint.impulse[c][Joint::lock] = along(c);
                else
                    joint.value[c] = g.coordinates[c].value;
            }
        }
        const JointDescription& strength = joint.description;
        const double over =
            std::max({joint.force.norm() / strength.break_force, reaction.force.norm() / strength.break_impulse,
                      joint.torque.norm() / strength.break_torque});
        if (over > tuning::joint_flight_over) return false;
        if (over <= 1.0) continue;
        joint.broken = true;
        joint.broken_at = step.from + step.h;
    }
    return true;
}

}  // namespace tumble
