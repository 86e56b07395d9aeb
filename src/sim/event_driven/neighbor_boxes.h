// Neighbor boxes: each moving body has a box that it stays in for a while, and the bodies whose boxes overlap it are
// its neighbors. A body that leaves its box gets another; no other body is visited.
#pragma once

#include "sim/detection/layer_filters.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/body_pair.h"
#include "sim/geometry/dynamic_tree.h"
#include "sim/math/bounds_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class NeighborBoxes {
public:
    explicit NeighborBoxes(const std::vector<Body>& bodies);

    /// Puts the body into this box and finds its neighbors; updates their lists.
    void enclose(std::uint32_t body, const Bounds& box);
    void list_fixed(const std::vector<Body>& bodies);
    /// Bodies have vanished or appeared, `changed`: none of them has a box then.
    void exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed);
    /// Pairs that are no neighbors, ascending: bodies of joints.
    void keep_apart(std::vector<BodyPair> pairs);
    bool known(std::uint32_t body) const { return tree_.holds(body); }
    bool encloses(std::uint32_t body, const Bounds& box) const;

    const std::vector<std::uint32_t>& moving(std::uint32_t body) const { return moving_[body]; }
    /// Fixed bodies near the body's box; half-spaces always.
    const std::vector<std::uint32_t>& fixed(std::uint32_t body) const { return standing_[body]; }
    /// True if a body could ever meet anything but half-spaces.
    bool crowded() const { return movers_ > 1 || !fixed_.empty(); }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [half_spaces, fixed, fixed_tree, tree, stack, movers, moving, standing, found, apart, filters] = self;
        archive.rebuilt(half_spaces, fixed, fixed_tree, movers, filters);
        archive.keep(tree, apart);
        archive.bodies_by_body(moving);
        archive.bodies_by_body(standing);
        archive.scratch(stack, found);
    }

private:
    std::vector<std::uint32_t> half_spaces_, fixed_;
    BoundsTree fixed_tree_;
    DynamicTree tree_;
    DynamicTree::Stack stack_;
    std::size_t movers_ = 0;
    std::vector<std::vector<std::uint32_t>> moving_, standing_;  // by body
    std::vector<std::uint32_t> found_;
    std::vector<BodyPair> apart_;
    LayerFilters filters_;
};

}  // namespace tumble
