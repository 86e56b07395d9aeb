// A bounding volume hierarchy over boxes: finds the boxes that overlap a given box, in logarithmic time per hit.
// One structure for moving bodies, for fixed bodies and for the triangles of a mesh. Built by median splits in n log n;
// the same input gives the same tree on every machine.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <vector>

namespace tumble {

class BoundsTree {
public:
    BoundsTree() = default;
    explicit BoundsTree(std::vector<Bounds> items);

    /// Calls visit(index) for each item whose bounds overlap the box; the order depends on the tree alone.
    template <class Visit>
    void query(const Bounds& box, Visit&& visit) const {
        if (nodes_.empty()) return;
        std::uint32_t stack[64];  // depth of a median-split tree of 2^32 items: 32
        int top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& node = nodes_[stack[--top]];
            if (!node.bounds.overlaps(box)) continue;
            if (node.count > 0) {
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                    if (items_[order_[i]].overlaps(box)) visit(order_[i]);
            } else {
                stack[top++] = node.first + 1;
                stack[top++] = node.first;
            }
        }
    }

    Bounds bounds() const { return nodes_.empty() ? Bounds{} : nodes_[0].bounds; }
    const Bounds& item(std::uint32_t index) const { return items_[index]; }

private:
    struct Node {
        Bounds bounds;
        std::uint32_t first = 0;  // index of the first item in order_, or of the first of two children
        std::uint32_t count = 0;  // number of items; 0: an inner node
    };
    void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

    std::vector<Bounds> items_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace tumble
