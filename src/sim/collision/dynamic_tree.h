// A bounding volume hierarchy whose boxes come, go and move one at a time: insertion where the surface grows least
// (Goldsmith and Salmon 1987), balance by rotations (Kopta and others 2012), all in logarithmic time.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <vector>

namespace tumble {

class DynamicTree {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// Puts in, or moves, the item with this index (indices are small whole numbers).
    void set(std::uint32_t item, const Bounds& box);
    void remove(std::uint32_t item);
    const Bounds& box(std::uint32_t item) const { return nodes_[leaf_[item]].box; }
    bool holds(std::uint32_t item) const { return item < leaf_.size() && leaf_[item] != none; }

    /// Calls visit(item) for each item whose box overlaps; in an order that depends on the tree's history.
    template <class Visit>
    void query(const Bounds& box, Visit&& visit) const {
        if (root_ == none) return;
        stack_.assign(1, root_);
        while (!stack_.empty()) {
            const Node& node = nodes_[stack_.back()];
            stack_.pop_back();
            if (!node.box.overlaps(box)) continue;
            if (node.leaf()) {
                visit(node.item);
            } else {
                stack_.push_back(node.child[1]);
                stack_.push_back(node.child[0]);
            }
        }
    }

private:
    struct Node {
        Bounds box;
        std::uint32_t parent = none;
        std::uint32_t child[2] = {none, none};
        std::uint32_t item = none;
        bool leaf() const { return child[0] == none; }
    };
    std::uint32_t take_node();
    void insert(std::uint32_t leaf);
    void take_out(std::uint32_t leaf);
    void refit(std::uint32_t node);
    void rotate(std::uint32_t node);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> free_, leaf_;   // nodes not in use; the leaf of each item
    std::uint32_t root_ = none;
    mutable std::vector<std::uint32_t> stack_;
};

}  // namespace tumble
