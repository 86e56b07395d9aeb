// A bounding volume hierarchy whose boxes are added, removed and moved one at a time: insertion where the surface area
// grows least (Goldsmith and Salmon 1987), balance by rotations (Kopta and others 2012), all in logarithmic time.
//
// A node holds the boxes of its two children, in single precision and rounded outwards, so that one cache line decides
// the descent. The items' own boxes stay in double precision, and results overlap those.
#pragma once

#include "core/vector.h"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace tumble {

class DynamicTree {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// Adds or moves the item with this index. Precondition: indices are small whole numbers, below 2^31.
    void set(std::uint32_t item, const Bounds& box);
    void remove(std::uint32_t item);
    const Bounds& box(std::uint32_t item) const { return items_[item].box; }
    bool holds(std::uint32_t item) const { return item < items_.size() && items_[item].held; }

    /// Working space of a query, one for each querying thread; kept so that queries allocate nothing.
    using Stack = std::vector<std::uint32_t>;

    /// Calls visit(item) for each item whose box overlaps, in an order that depends on the tree's history.
    template <class Visit>
    void query(const Bounds& box, Stack& stack, Visit&& visit) const {
        const auto search = [&](std::uint32_t child) {
            if (!leaf(child))
                stack.push_back(child);
            else if (items_[item_of(child)].box.overlaps(box))
                visit(item_of(child));
        };
        if (root_ == none) return;
        const Box wide(box);
        stack.clear();
        search(root_);
        while (!stack.empty()) {
            const Node& node = nodes_[stack.back()];
            stack.pop_back();
            for (int side = 1; side >= 0; --side)
                if (node.box[side].overlaps(wide)) search(node.child[side]);
        }
    }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [nodes, free, items, root] = self;
        archive.within_bodies(items);
        archive.scratch(nodes, free,
                        root);  // built from the boxes; only the order of a query's results depends on them
        if constexpr (!std::is_const_v<Self>) self.build();
    }

private:
    struct Box {
        float min[3], max[3];

        Box() = default;
        explicit Box(const Bounds& exact);
        bool operator==(const Box&) const = default;
        // Branch-free, because the outcome is unpredictable.
        bool overlaps(const Box& b) const {
            return (min[0] <= b.max[0]) & (b.min[0] <= max[0]) & (min[1] <= b.max[1]) & (b.min[1] <= max[1]) &
                   (min[2] <= b.max[2]) & (b.min[2] <= max[2]);
        }
        float surface() const;
    };
    // A child is a node index, or an item index with the highest bit set.
    struct alignas(64) Node {
        Box box[2];
        std::uint32_t child[2] = {none, none};
        std::uint32_t parent = none;
    };
    struct Item {
        Bounds box;
        std::uint32_t parent = none;
        bool held = false;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [box, parent, held] = self;
            archive.keep(held);
            if (held) archive.keep(box);
            archive.scratch(parent);
        }
    };
    static constexpr std::uint32_t leaf_bit = std::uint32_t(1) << 31;
    static bool leaf(std::uint32_t child) { return (child & leaf_bit) != 0; }
    static std::uint32_t item_of(std::uint32_t child) { return child & ~leaf_bit; }

    void build();
    static Box joined(const Box& a, const Box& b);
    std::uint32_t& parent(std::uint32_t child) {
        return leaf(child) ? items_[item_of(child)].parent : nodes_[child].parent;
    }
    int side_of(std::uint32_t child) { return nodes_[parent(child)].child[1] == child; }
    void put(std::uint32_t node, int side, std::uint32_t child, const Box& box);
    std::uint32_t take_node();
    void insert(std::uint32_t item, const Box& box);
    void take_out(std::uint32_t item);
    void resize(std::uint32_t child, Box box);
    void rotate(std::uint32_t node);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> free_;  // indices of unused nodes
    std::vector<Item> items_;
    std::uint32_t root_ = none;  // a node, or the only item
};

}  // namespace tumble
