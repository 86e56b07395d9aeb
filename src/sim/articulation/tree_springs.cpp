#include "sim/articulation/tree_springs.h"

#include "sim/joints/flight_way.h"
#include "sim/joints/joint_set.h"

#include <algorithm>
#include <cmath>

namespace tumble {
bool TreeSprings::find(const JointTree& tree, const TreeStep& step) {
    list_.clear();
    dampers_ = 0;
    fastest_ = 0.0;
    for (const Joint* joint : step.joints)
        if (!acts_along_coordinates(*joint)) return false;
    for (int k = 0; k < int(tree.nodes().size()); ++k) {
        const TreeNode& node = tree.nodes()[std::size_t(k)];
        if (node.kind != NodeKind::revolute && node.kind != NodeKind::prismatic) continue;
        const Joint& joint = *step.joints[std::size_t(node.joint)];
        if (!joint.axis(node.coordinate).spring) continue;
        const JointSpring& law = joint.springs[node.coordinate];
        const JointGeometry g = measure(joint, side_of(step.bodies, joint.a), side_of(step.bodies, joint.b));
        const double rest = law.rest - g.coordinates[node.coordinate].value;
        const double gives = compliance_along(step.bodies, joint, g, node.coordinate);
        const int heat = law.damping > 0.0 ? dampers_++ : -1;
        list_.push_back({k, node.joint, node.at, node.speed_at, heat, law.stiffness, law.damping, node.sign * rest});
        fastest_ = std::max(fastest_, std::sqrt(law.stiffness * gives) + law.damping * gives);
    }
    return true;
}

void TreeSprings::drive(ForwardDynamics& dynamics, const double* q, const double* speeds, double* heat_rates) const {
    for (const Spring& spring : list_) {
        const double speed = speeds[spring.speed_at];
        dynamics.drive(spring.node, spring.stiffness * (spring.pull - q[spring.at]) - spring.damping * speed);
        if (spring.heat >= 0) heat_rates[spring.heat] = spring.damping * speed * speed;
    }
}

// The loss of potential energy, less the heat.
void TreeSprings::account(const TreeStep& step, const double* q, const double* heats) const {
    for (const Spring& spring : list_) {
        const double moved = q[spring.at];
        double done = spring.stiffness * moved * (spring.pull - 0.5 * moved);
        if (spring.heat >= 0) done -= heats[spring.heat];
        step.joints[std::size_t(spring.joint)]->account.step.work.springs += done;
    }
}

}  // namespace tumble
