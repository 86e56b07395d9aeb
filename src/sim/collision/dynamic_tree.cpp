#include "sim/collision/dynamic_tree.h"

namespace tumble {
namespace {

double surface(const Bounds& b) {
    const Vec3 e = b.extent();
    return e.x() * e.y() + e.y() * e.z() + e.z() * e.x();
}

Bounds joined(Bounds a, const Bounds& b) {
    a.add(b);
    return a;
}

}  // namespace

std::uint32_t DynamicTree::take_node() {
    if (free_.empty()) {
        nodes_.emplace_back();
        return std::uint32_t(nodes_.size() - 1);
    }
    const std::uint32_t node = free_.back();
    free_.pop_back();
    nodes_[node] = Node{};
    return node;
}

void DynamicTree::set(std::uint32_t item, const Bounds& box) {
    if (item >= leaf_.size()) leaf_.resize(item + 1, none);
    std::uint32_t& leaf = leaf_[item];
    if (leaf == none) {
        leaf = take_node();
        nodes_[leaf].item = item;
    } else {
        take_out(leaf);
    }
    nodes_[leaf].box = box;
    insert(leaf);
}

void DynamicTree::remove(std::uint32_t item) {
    if (!holds(item)) return;
    take_out(leaf_[item]);
    free_.push_back(leaf_[item]);
    leaf_[item] = none;
}

void DynamicTree::insert(std::uint32_t leaf) {
    if (root_ == none) {
        root_ = leaf;
        nodes_[leaf].parent = none;
        return;
    }
    // Down to where the joint box with the new one costs least, counting what all boxes on the way grow by.
    const Bounds box = nodes_[leaf].box;
    std::uint32_t at = root_;
    while (!nodes_[at].leaf()) {
        const double here = surface(joined(nodes_[at].box, box)), grown = here - surface(nodes_[at].box);
        double cost[2];
        for (int k = 0; k < 2; ++k) {
            const Node& child = nodes_[nodes_[at].child[k]];
            cost[k] = grown + surface(joined(child.box, box)) - (child.leaf() ? 0.0 : surface(child.box));
        }
        if (here < cost[0] && here < cost[1]) break;
        at = nodes_[at].child[cost[1] < cost[0]];
    }
    const std::uint32_t parent = nodes_[at].parent, joint = take_node();
    nodes_[joint].parent = parent;
    nodes_[joint].child[0] = at;
    nodes_[joint].child[1] = leaf;
    nodes_[at].parent = nodes_[leaf].parent = joint;
    if (parent == none) root_ = joint;
    else nodes_[parent].child[nodes_[parent].child[1] == at] = joint;
    refit(joint);
}

void DynamicTree::take_out(std::uint32_t leaf) {
    const std::uint32_t joint = nodes_[leaf].parent;
    if (joint == none) {
        root_ = none;
        return;
    }
    const std::uint32_t sibling = nodes_[joint].child[nodes_[joint].child[0] == leaf], parent = nodes_[joint].parent;
    nodes_[sibling].parent = parent;
    free_.push_back(joint);
    if (parent == none) {
        root_ = sibling;
        return;
    }
    nodes_[parent].child[nodes_[parent].child[1] == joint] = sibling;
    refit(parent);
}

void DynamicTree::refit(std::uint32_t node) {
    for (; node != none; node = nodes_[node].parent) {
        nodes_[node].box = joined(nodes_[nodes_[node].child[0]].box, nodes_[nodes_[node].child[1]].box);
        rotate(node);
    }
}

// Swaps a child with a grandchild on the other side where that makes the other side's box smaller.
void DynamicTree::rotate(std::uint32_t node) {
    double best = 0.0;
    int best_side = -1, best_grandchild = 0;
    for (int side = 0; side < 2; ++side) {
        const std::uint32_t other = nodes_[node].child[1 - side];
        if (nodes_[other].leaf()) continue;
        const Bounds& moved = nodes_[nodes_[node].child[side]].box;
        for (int k = 0; k < 2; ++k) {
            // child[side] would take the place of grandchild k.
            const double gain = surface(nodes_[other].box) - surface(joined(moved, nodes_[nodes_[other].child[1 - k]].box));
            if (gain <= best) continue;
            best = gain;
            best_side = side;
            best_grandchild = k;
        }
    }
    if (best_side < 0) return;
    const std::uint32_t lower = nodes_[node].child[best_side], other = nodes_[node].child[1 - best_side];
    const std::uint32_t raised = nodes_[other].child[best_grandchild];
    nodes_[node].child[best_side] = raised;
    nodes_[raised].parent = node;
    nodes_[other].child[best_grandchild] = lower;
    nodes_[lower].parent = other;
    nodes_[other].box = joined(nodes_[nodes_[other].child[0]].box, nodes_[nodes_[other].child[1]].box);
}

}  // namespace tumble
