// A bounding volume hierarchy over boxes: finds the boxes that overlap a given box, in logarithmic time per hit.
// One structure for moving bodies, for fixed bodies and for the triangles of a mesh. Built by median splits in n log n;
// the same input gives the same tree on every machine.
#pragma once

#include "core/vector.h"

#include <algorithm>
#include <cstdint>
#include <span>
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

// Halves a set of bodies by position: cut at the median along a side of their bounding box, and recursively (k-d tree,
// Bentley 1975). The halves depend on the bodies alone: at equal positions the lower index comes first.

struct PlacedBody {
    Vec3 position;  // m
    std::uint32_t body;

    static auto before(int axis) {
        return [axis](const PlacedBody& l, const PlacedBody& r) {
            return l.position[axis] != r.position[axis] ? l.position[axis] < r.position[axis] : l.body < r.body;
        };
    }
};

/// The axis of largest spread, except `skipped`.
inline int longest_side(std::span<const PlacedBody> items, int skipped = -1) {
    Bounds box;
    for (const PlacedBody& item : items) box.add(item.position);
    Vec3 extent = box.extent();
    if (skipped >= 0) extent[skipped] = -1.0;
    int axis = 0;
    extent.maxCoeff(&axis);
    return axis;
}

/// Moves the lower half to the front and returns its size.
inline std::size_t cut_at_median(std::span<PlacedBody> items, int axis) {
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(half), items.end(), PlacedBody::before(axis));
    return half;
}

}  // namespace tumble
