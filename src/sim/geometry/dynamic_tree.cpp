#include "sim/geometry/dynamic_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

DynamicTree::Box::Box(const Bounds& exact) {
    constexpr float ulp = std::numeric_limits<float>::epsilon(), least = std::numeric_limits<float>::min();
    for (int k = 0; k < 3; ++k) {
        const float low = float(exact.min[k]), high = float(exact.max[k]);
        min[k] = low - (ulp * std::abs(low) + least);
        max[k] = high + (ulp * std::abs(high) + least);
    }
}

float DynamicTree::Box::surface() const {
    const float x = max[0] - min[0], y = max[1] - min[1], z = max[2] - min[2];
    return x * y + y * z + z * x;
}

DynamicTree::Box DynamicTree::joined(const Box& a, const Box& b) {
    Box box;
    for (int k = 0; k < 3; ++k) {
        box.min[k] = std::min(a.min[k], b.min[k]);
        box.max[k] = std::max(a.max[k], b.max[k]);
    }
    return box;
}

void DynamicTree::put(std::uint32_t node, int side, std::uint32_t child, const Box& box) {
    nodes_[node].child[side] = child;
    nodes_[node].box[side] = box;
    parent(child) = node;
}

std::uint32_t DynamicTree::take_node() {
    if (free_.empty()) {
        nodes_.emplace_back();
        return std::uint32_t(nodes_.size() - 1);
    }
    const std::uint32_t node = free_.back();
    free_.pop_back();
    return node;
}

void DynamicTree::set(std::uint32_t item, const Bounds& box) {
    if (item >= items_.size()) items_.resize(item + 1);
    Item& entry = items_[item];
    // An item that has moved little keeps its node: the tree around it fits nearly as well.
    const bool stays = entry.held && entry.box.overlaps(box);
    if (entry.held && !stays) take_out(item);
    entry.box = box;
    entry.held = true;
    if (stays)
        resize(item | leaf_bit, Box(box));
    else
        insert(item, Box(box));
}

// From the items' boxes.
void DynamicTree::build() {
    nodes_.clear();
    free_.clear();
    root_ = none;
    for (std::uint32_t item = 0; item < items_.size(); ++item)
        if (items_[item].held) insert(item, Box(items_[item].box));
}

void DynamicTree::remove(std::uint32_t item) {
    if (!holds(item)) return;
    take_out(item);
    items_[item].held = false;
}

// Descends to the node where the joint box costs least, counting the growth of all boxes on the path.
void DynamicTree::insert(std::uint32_t item, const Box& box) {
    const std::uint32_t added = item | leaf_bit;
    if (root_ == none) {
        root_ = added;
        parent(added) = none;
        return;
    }
    std::uint32_t at = root_;
    Box around = leaf(at) ? Box(items_[item_of(at)].box) : joined(nodes_[at].box[0], nodes_[at].box[1]);
    while (!leaf(at)) {
        const Node& node = nodes_[at];
        const float here = joined(around, box).surface(), grown = here - around.surface();
        float cost[2];
        for (int side = 0; side < 2; ++side)
            cost[side] = grown + joined(node.box[side], box).surface() -
                         (leaf(node.child[side]) ? 0.0f : node.box[side].surface());
        if (here < cost[0] && here < cost[1]) break;
        const int side = cost[1] < cost[0];
        around = node.box[side];
        at = node.child[side];
    }
    const std::uint32_t above = parent(at);
    const int side = above == none ? 0 : side_of(at);
    const std::uint32_t joint = take_node();
    put(joint, 0, at, around);
    put(joint, 1, added, box);
    nodes_[joint].parent = above;
    if (above == none) {
        root_ = joint;
        return;
    }
    nodes_[above].child[side] = joint;
    resize(joint, joined(around, box));
}

void DynamicTree::take_out(std::uint32_t item) {
    const std::uint32_t taken = item | leaf_bit, joint = parent(taken);
    if (joint == none) {
        root_ = none;
        return;
    }
    const int other = 1 - side_of(taken);
    const std::uint32_t sibling = nodes_[joint].child[other], above = nodes_[joint].parent;
    const Box box = nodes_[joint].box[other];
    free_.push_back(joint);
    if (above == none) {
        root_ = sibling;
        parent(sibling) = none;
        return;
    }
    const int side = side_of(joint);
    put(above, side, sibling, nodes_[above].box[side]);
    resize(sibling, box);
}

// Sets a child's box, and the boxes of its ancestors as far as they change.
void DynamicTree::resize(std::uint32_t child, Box box) {
    for (std::uint32_t node = parent(child); node != none; node = parent(child)) {
        Box& old = nodes_[node].box[side_of(child)];
        if (old == box) return;
        old = box;
        rotate(node);
        box = joined(nodes_[node].box[0], nodes_[node].box[1]);
        child = node;
    }
}

// Swaps a child with a grandchild on the other side where that shrinks the other side's box.
void DynamicTree::rotate(std::uint32_t node) {
    float best = 0.0f;
    int best_side = -1, best_grandchild = 0;
    const Node& top = nodes_[node];
    for (int side = 0; side < 2; ++side) {
        if (leaf(top.child[1 - side])) continue;
        const Node& other = nodes_[top.child[1 - side]];
        const float now = top.box[1 - side].surface();
        for (int k = 0; k < 2; ++k) {
            // child[side] would replace grandchild k.
            const float gain = now - joined(top.box[side], other.box[1 - k]).surface();
            if (gain <= best) continue;
            best = gain;
            best_side = side;
            best_grandchild = k;
        }
    }
    if (best_side < 0) return;
    const std::uint32_t lower = top.child[best_side], other = top.child[1 - best_side];
    const Box lower_box = top.box[best_side];
    const std::uint32_t raised = nodes_[other].child[best_grandchild];
    put(node, best_side, raised, nodes_[other].box[best_grandchild]);
    put(other, best_grandchild, lower, lower_box);
    nodes_[node].box[1 - best_side] = joined(nodes_[other].box[0], nodes_[other].box[1]);
}

}  // namespace tumble
