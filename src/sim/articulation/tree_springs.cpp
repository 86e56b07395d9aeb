#include "sim/articulation/tree_springs.h"

#include "sim/joints/joint_set.h"
#include "sim/joints/joint_way.h"
#include "sim/joints/settings.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Largest rate of a damper times the step in a flight by Verlet's method: speeds that fall faster would change their
/// sign.
constexpr double joint_flight_damper = 2.0;

}  // namespace
bool TreeSprings::find(const JointTree& tree, const TreeStep& step, double stage) {
    list_.clear();
    dampers_ = 0;
    fastest_ = 0.0;
    stiff_ = false;
    bool any = false;
    for (const Joint* joint : step.joints) {
        if (!acts_along_coordinates(*joint)) return false;
        any = any || has_springs(*joint) || has_motors(*joint);
    }
    if (!any) return true;
    for (int k = 0; k < int(tree.nodes().size()); ++k) {
        const TreeNode& node = tree.nodes()[std::size_t(k)];
        if (node.kind != NodeKind::revolute && node.kind != NodeKind::prismatic) continue;
        const Joint& joint = *step.joints[std::size_t(node.joint)];
        const JointAxis& axis = joint.axis(node.coordinate);
        const bool drives = axis.motor && !axis.motor->speed;
        if (!axis.spring && !drives) continue;
        const JointGeometry g = measure(joint, side_of(step.bodies, joint.a), side_of(step.bodies, joint.b));
        const double value = g.coordinates[node.coordinate].value;
        const double gives = compliance_along(step.bodies, joint, g, node.coordinate);
        const auto add = [&](double stiffness, double damping, double rest, double most, bool motor) {
            Spring& law = list_.emplace_back();
            law.node = k;
            law.joint = node.joint;
            law.at = node.at;
            law.speed_at = node.speed_at;
            law.stiffness = stiffness;
            law.damping = damping;
            law.pull = node.sign * (rest - value);
            law.most = most;
            law.motor = motor;
            law.stiff = stage * std::sqrt(stiffness * gives) > tuning::joint_flight_spring ||
                        stage * damping * gives > joint_flight_damper;
            if (damping > 0.0 || law.stiff || motor) law.heat = dampers_++;
            stiff_ = stiff_ || law.stiff;
            fastest_ = std::max(fastest_, std::sqrt(stiffness * gives) + damping * gives);
        };
        if (axis.spring) {
            const JointSpring& spring = joint.springs[node.coordinate];
            add(spring.stiffness, spring.damping, spring.rest, infinity, false);
        }
        if (drives)
            add(axis.motor->stiffness, axis.motor->damping, axis.motor->targets[0].value, axis.motor->max_force, true);
    }
    return true;
}

bool TreeSprings::within_bounds(const double* q, const double* speeds) const {
    return std::all_of(list_.begin(), list_.end(),
                       [&](const Spring& spring) { return std::abs(spring.effort_at(q, speeds)) <= spring.most; });
}

void TreeSprings::drive(ForwardDynamics& dynamics, const double* q, const double* speeds, double* heat_rates) const {
    for (const Spring& spring : list_) {
        const double speed = speeds[spring.speed_at], effort = spring.effort_at(q, speeds);
        dynamics.drive(spring.node, effort);
        if (spring.heat >= 0) heat_rates[spring.heat] = speed * (spring.motor ? effort : spring.damping * speed);
    }
}

void TreeSprings::drive_stage(ForwardDynamics& dynamics, const double* start, const double* speeds,
                              const double* middle, double h, bool first) const {
    for (const Spring& spring : list_) {
        dynamics.drive(spring.node, spring.effort(start, speeds, middle, h));
        if (first) dynamics.add_inertia(spring.node, spring.inertia(h));
    }
}

// A stiff spring loses energy by the method too.
void TreeSprings::heat_stage(const double* start, const double* speeds, const double* middle, const double* after,
                             double h, double* heats) const {
    for (const Spring& spring : list_) {
        if (spring.heat < 0) continue;
        const double before = speeds[spring.speed_at], mean = 0.5 * (before + after[spring.speed_at]), moved = h * mean;
        const double force =
            spring.effort(start, speeds, middle, h) - spring.inertia(h) * (after[spring.speed_at] - before) / h;
        if (spring.motor)
            heats[spring.heat] += moved * force;
        else if (spring.stiff)
            heats[spring.heat] += moved * (spring.stiffness * (spring.pull - start[spring.at] - 0.5 * moved) - force);
        else
            heats[spring.heat] += moved * spring.damping * mean;
    }
}

// The loss of potential energy, less the heat.
void TreeSprings::account(const TreeStep& step, const double* q, const double* heats) const {
    for (const Spring& spring : list_) {
        JointWork& work = step.joints[std::size_t(spring.joint)]->account.step.work;
        (spring.motor ? work.motors : work.springs) += spring.work(q, heats);
    }
}

}  // namespace tumble
