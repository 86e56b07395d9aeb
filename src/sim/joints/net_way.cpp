#include "sim/joints/net_way.h"

#include "sim/joints/joint_groups.h"
#include "sim/joints/joint_set.h"
#include "sim/joints/settings.h"
#include "sim/math/block_cholesky.h"

#include <algorithm>

namespace tumble {
namespace {

bool integrator_known(const Body& body) { return body.integrator == IntegratorKind::symplectic_euler; }

bool all_known(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies) {
    return std::all_of(group.bodies.begin(), group.bodies.end(),
                       [&](std::uint32_t i) { return integrator_known(bodies[i]); }) &&
           std::all_of(group.joints.begin(), group.joints.end(),
                       [&](std::uint32_t k) { return known_to_sweeps(joints.joints()[k]); });
}

bool has_more_joints(const JointGroup& group) { return group.joints.size() > group.bodies.size(); }

}  // namespace

bool known_to_sweeps(const Joint& joint) {
    const JointDescription& description = joint.description;
    if (joint.gear() || description.ever_breaks()) return false;
    std::size_t rubs = 0;
    bool drives = description.friction_coefficient > 0.0, swing_limited = false;
    for (std::size_t c = 0; c < joint.count(); ++c) {
        const JointAxis& axis = joint.axis(c);
        const bool turns = c >= 3, limited = axis.motion == JointAxis::Motion::limited;
        if (axis.motor || (limited && axis.restitution > 0.0)) return false;
        // Dampers and friction of turns alone; no springs.
        if ((axis.spring || axis.friction > 0.0) && !turns) return false;
        if (axis.spring && (joint.springs[c].stiffness > 0.0 || axis.spring->frequency > 0.0)) return false;
        if (!joint.distance() && !turns && axis.motion != JointAxis::Motion::locked) return false;
        drives = drives || axis.spring || axis.friction > 0.0;
        swing_limited = swing_limited || (turns && c > 3 && limited);
        rubs += turns && axis.motion != JointAxis::Motion::locked &&
                (axis.friction > 0.0 || description.friction_coefficient > 0.0);
    }
    if (joint.distance()) return !(description.friction_coefficient > 0.0);
    if (joint.turns_alike()) return !swing_limited || !(drives || description.swing);
    return rubs <= 1 && !description.swing;  // friction has one bound
}

double factor_work(const JointGroup& group, const JointSet& joints) {
    const auto place = [&](std::uint32_t body) {
        const auto found = std::lower_bound(group.bodies.begin(), group.bodies.end(), body);
        return found != group.bodies.end() && *found == body ? std::int64_t(found - group.bodies.begin()) : -1;
    };
    std::vector<BlockCholesky::Pair> pairs;
    for (const std::uint32_t k : group.joints) {
        const Joint& joint = joints.joints()[k];
        const std::int64_t a = place(joint.a), b = place(joint.b);
        if (a >= 0 && b >= 0 && a != b) pairs.push_back({std::uint32_t(a), std::uint32_t(b)});
    }
    BlockCholesky matrix;
    matrix.analyze(group.bodies.size(), pairs);
    return double(matrix.work()) / double(group.bodies.size());
}

bool is_net(const JointGroup& group, const JointSet& joints, const std::vector<Body>& bodies, NetRule rule) {
    if (rule == NetRule::none || !all_known(group, joints, bodies)) return false;
    if (rule == NetRule::all) return true;
    if (!has_more_joints(group)) return false;
    bool ropes = false;
    for (const std::uint32_t k : group.joints) {
        const Joint& joint = joints.joints()[k];
        ropes = ropes || (joint.distance() && !joint.locked(0));
        const auto dynamic = [&](std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); };
        if (!dynamic(joint.a) || !dynamic(joint.b)) continue;
        const double a = bodies[joint.a].mass, b = bodies[joint.b].mass;
        if (std::max(a, b) > tuning::net_mass_ratio * std::min(a, b)) return false;
    }
    if (ropes && group.bodies.size() >= tuning::net_bodies_of_ropes) return true;
    return group.bodies.size() >= tuning::net_bodies && factor_work(group, joints) > tuning::net_work;
}

void Nets::find(const JointSet& joints, const std::vector<Body>& bodies, NetRule rule) {
    if (found_ == joints.changes()) return;
    found_ = joints.changes();
    role_.assign(bodies.size(), Role::plain);
    for (const JointGroup& group : find_joint_groups(joints, bodies)) {
        const Role role = !all_known(group, joints, bodies)      ? Role::unknown
                          : !is_net(group, joints, bodies, rule) ? Role::plain
                          : has_more_joints(group)               ? Role::entangled
                                                                 : Role::loose;
        for (const std::uint32_t i : group.bodies) role_[i] = role;
    }
}

Nets::Way Nets::way(std::span<const std::uint32_t> bodies) const {
    bool net = false, unknown = false;
    if (role_.empty()) return Way::direct;
    for (const std::uint32_t i : bodies) {
        net = net || role_[i] == Role::loose || role_[i] == Role::entangled;
        unknown = unknown || role_[i] == Role::unknown;
    }
    return !net ? Way::direct : unknown ? Way::mixed : Way::sweeps;
}

bool Nets::entangled(std::span<const std::uint32_t> bodies) const {
    return std::any_of(bodies.begin(), bodies.end(), [&](std::uint32_t i) { return role_[i] == Role::entangled; });
}

}  // namespace tumble
