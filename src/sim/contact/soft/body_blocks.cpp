#include "sim/contact/soft/body_blocks.h"

#include <algorithm>

namespace tumble {

void BodyBlocks::clear() {
    order_.clear();
    first_.assign(1, 0);
    open_ = false;
}

void BodyBlocks::add(std::span<const std::uint32_t> island, const std::vector<Body>& bodies) {
    if (island.size() <= most_) {
        if (!open_ || order_.size() + island.size() - first_[first_.size() - 2] > most_)
            first_.push_back(order_.size());
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

// The items are ascending by body, and so are those of each half.
void BodyBlocks::cut(std::span<PlacedBody> items) {
    if (items.size() <= most_) {
        for (const PlacedBody& item : items) order_.push_back(item.body);
        first_.push_back(order_.size());
        return;
    }
    const int axis = longest_side(items);
    halves_.assign(items.begin(), items.end());
    const std::size_t half = cut_at_median(halves_, axis);
    const auto lower = [before = PlacedBody::before(axis), median = halves_[half]](const PlacedBody& item) {
        return before(item, median);
    };
    const auto upper_half = std::copy_if(items.begin(), items.end(), halves_.begin(), lower);
    std::remove_copy_if(items.begin(), items.end(), upper_half, lower);
    std::copy(halves_.begin(), halves_.end(), items.begin());
    cut(items.first(half));
    cut(items.subspan(half));
}

}  // namespace tumble
