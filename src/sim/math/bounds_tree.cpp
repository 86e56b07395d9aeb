#include "sim/math/bounds_tree.h"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {
constexpr std::uint32_t leaf_size =
    4;  // items; a smaller leaf costs nodes, a larger one tests (measured flat between 2 and 8)
}

BoundsTree::BoundsTree(std::vector<Bounds> items) : items_(std::move(items)), order_(items_.size()) {
    if (items_.empty()) return;
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(items_.size());
    nodes_.emplace_back();
    build(0, 0, std::uint32_t(items_.size()));
}

void BoundsTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    Bounds all, centers;
    for (std::uint32_t i = first; i < first + count; ++i) {
        all.add(items_[order_[i]]);
        centers.add(items_[order_[i]].center());
    }
    nodes_[node].bounds = all;
    if (count <= leaf_size) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    int axis = 0;
    centers.extent().maxCoeff(&axis);
    const std::uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
        const double ca = items_[a].min[axis] + items_[a].max[axis], cb = items_[b].min[axis] + items_[b].max[axis];
        return ca != cb ? ca < cb : a < b;
    });
    const auto children = std::uint32_t(nodes_.size());
    nodes_[node].first = children;
    nodes_.emplace_back();
    nodes_.emplace_back();
    build(children, first, half);
    build(children + 1, first + half, count - half);
}

}  // namespace tumble
