#include "sim/joints/spanning_joints.h"

#include "core/disjoint_sets.h"
#include "sim/joints/joint_way.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr int of_law = int(Joint::coordinates) + 1;

// Springs, motors, friction, limits and armature act along coordinates of the tree.
bool has_laws(const Joint& joint) {
    return has_springs(joint) || has_motors(joint) || has_friction(joint) || limited(joint) ||
           joint.description.armature;
}

int place_in(std::span<const std::uint32_t> bodies, std::uint32_t body) {
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), body);
    return found != bodies.end() && *found == body ? int(found - bodies.begin()) : SpanningJoints::ground;
}

}  // namespace

// Kruskal's method: joints with laws first, then joints that would be the most rows.
bool span_joints(std::span<const std::uint32_t> bodies, std::span<const Joint* const> joints,
                 std::span<const Joint> all, SpanningJoints& tree) {
    const std::size_t n = bodies.size(), m = joints.size();
    tree = {};
    tree.ends.resize(2 * m);
    tree.kept.assign(m, 0);
    DisjointSets edges(n + 1), whole(n + 1);
    std::vector<int> weight(m, 0);
    std::vector<std::size_t> list;
    const auto set_of = [&](std::size_t end) {
        return tree.ends[end] == SpanningJoints::ground ? n : std::size_t(tree.ends[end]);
    };
    for (std::size_t k = 0; k < m; ++k) {
        const Joint& joint = *joints[k];
        if (joint.broken) return false;
        tree.ends[2 * k] = joint.a == Joint::world ? SpanningJoints::ground : place_in(bodies, joint.a);
        tree.ends[2 * k + 1] = joint.b == Joint::world ? SpanningJoints::ground : place_in(bodies, joint.b);
        whole.join(set_of(2 * k), set_of(2 * k + 1));
        if (joint.gear()) continue;
        tree.free = tree.free && set_of(2 * k) != n && set_of(2 * k + 1) != n;
        if (joint.distance()) continue;
        for (std::size_t c = 0; c < Joint::coordinates; ++c) weight[k] += joint.locked(c);
        if (has_laws(joint)) weight[k] += of_law;
        list.push_back(k);
    }
    for (const Joint* gear : joints) {
        if (!gear->gear()) continue;
        for (const std::size_t k : gear->description.geared) {
            const auto of = std::find(joints.begin(), joints.end(), k < all.size() ? &all[k] : nullptr);
            if (of == joints.end()) return false;
            weight[std::size_t(of - joints.begin())] = 2 * of_law;
        }
    }
    for (std::size_t k = 1; k < n; ++k)
        if (whole.root(k) != whole.root(0)) return false;
    std::stable_sort(list.begin(), list.end(), [&](std::size_t a, std::size_t b) { return weight[a] > weight[b]; });
    for (const std::size_t k : list) tree.kept[k] = edges.join(set_of(2 * k), set_of(2 * k + 1));
    for (std::size_t k = 0; k < m; ++k) {
        if (tree.kept[k]) continue;
        if (weight[k] >= of_law) return false;
        tree.cut.push_back(int(k));
        tree.rows += joints[k]->gear() ? 1 : joints[k]->distance() ? joints[k]->locked(0) : weight[k];
    }
    return true;
}

bool has_few_loops(std::span<const std::uint32_t> bodies, std::span<const Joint* const> joints,
                   std::span<const Joint> all) {
    SpanningJoints tree;
    return span_joints(bodies, joints, all, tree) && tree.rows <= tuning::tree_most_closures;
}

}  // namespace tumble
