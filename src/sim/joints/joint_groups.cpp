#include "sim/joints/joint_groups.h"

#include "core/disjoint_sets.h"
#include "core/sort_unique.h"

#include <algorithm>

namespace tumble {

std::vector<JointGroup> find_joint_groups(const JointSet& joints, const std::vector<Body>& bodies) {
    const auto dynamic = [&](std::uint32_t i) { return i != Joint::world && bodies[i].dynamic(); };
    DisjointSets sets(bodies.size());
    const auto root = [&](std::uint32_t i) { return std::uint32_t(sets.root(i)); };
    std::vector<std::uint32_t> holding;
    for (const std::uint32_t k : joints.active())
        if (!joints.joints()[k].broken) holding.push_back(k);
    for (const std::uint32_t k : holding) {
        const Joint& joint = joints.joints()[k];
        if (dynamic(joint.a) && dynamic(joint.b)) sets.join(joint.a, joint.b);
    }
    std::vector<std::uint32_t> lowest;
    for (const std::uint32_t k : holding) {
        const Joint& joint = joints.joints()[k];
        if (dynamic(joint.a) || dynamic(joint.b)) lowest.push_back(root(dynamic(joint.a) ? joint.a : joint.b));
    }
    sort_unique(lowest);
    std::vector<JointGroup> groups(lowest.size());
    for (const std::uint32_t k : holding) {
        const Joint& joint = joints.joints()[k];
        const bool a = dynamic(joint.a), b = dynamic(joint.b);
        if (!a && !b) continue;
        const auto place = std::lower_bound(lowest.begin(), lowest.end(), root(a ? joint.a : joint.b));
        JointGroup& group = groups[std::size_t(place - lowest.begin())];
        group.joints.push_back(k);
        group.anchored = group.anchored || !a || !b;
        if (a) group.bodies.push_back(joint.a);
        if (b) group.bodies.push_back(joint.b);
    }
    for (JointGroup& group : groups) sort_unique(group.bodies);
    return groups;
}

}  // namespace tumble
