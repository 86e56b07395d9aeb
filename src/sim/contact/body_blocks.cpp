#include "sim/contact/body_blocks.h"

#include <algorithm>

namespace tumble {

void BodyBlocks::clear() {
    order_.clear();
    first_.assign(1, 0);
    open_ = false;
}

void BodyBlocks::add(std::span<const std::uint32_t> island, const std::vector<Body>& bodies) {
    if (island.size() <= most_) {
        if (!open_ || order_.size() + island.size() - first_[first_.size() - 2] > most_) first_.push_back(order_.size());
        order_.insert(order_.end(), island.begin(), island.end());
        first_.back() = order_.size();
        open_ = true;
        return;
    }
    items_.clear();
    for (const std::uint32_t i : island) items_.push_back({bodies[i].position, i});
    cut(items_);
    open_ = false;
}

void BodyBlocks::cut(std::span<PlacedBody> items) {
    if (items.size() <= most_) {
        const std::size_t first = order_.size();
        for (const PlacedBody& item : items) order_.push_back(item.body);
        std::sort(order_.begin() + std::ptrdiff_t(first), order_.end());
        first_.push_back(order_.size());
        return;
    }
    const std::size_t half = cut_at_median(items, longest_side(items));
    cut(items.first(half));
    cut(items.subspan(half));
}

}  // namespace tumble
