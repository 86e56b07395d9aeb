#include "sim/event_driven/neighbor_boxes.h"

#include <algorithm>

namespace tumble {

NeighborBoxes::NeighborBoxes(const std::vector<Body>& bodies)
    : moving_(bodies.size()), standing_(bodies.size()), filters_(bodies) {
    list_fixed(bodies);
}

void NeighborBoxes::list_fixed(const std::vector<Body>& bodies) {
    half_spaces_.clear();
    fixed_.clear();
    movers_ = 0;
    std::vector<Bounds> bounds;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        const Body& body = bodies[i];
        if (body.absent) continue;
        if (std::holds_alternative<HalfSpace>(body.collider)) {
            half_spaces_.push_back(i);
        } else if (body.moves()) {
            ++movers_;
        } else {
            fixed_.push_back(i);
            bounds.push_back(world_bounds(body.collider, body.pose()));
        }
    }
    fixed_tree_ = BoundsTree(std::move(bounds));
}

void NeighborBoxes::exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed) {
    list_fixed(bodies);
    for (const std::uint32_t i : changed) {
        for (const std::uint32_t other : moving_[i]) std::erase(moving_[other], i);
        moving_[i].clear();
        standing_[i].clear();
        tree_.remove(i);
    }
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (known(i)) enclose(i, Bounds(tree_.box(i)));
}

bool NeighborBoxes::encloses(std::uint32_t body, const Bounds& box) const {
    if (!tree_.holds(body)) return false;
    const Bounds& held = tree_.box(body);
    return (box.min.array() >= held.min.array()).all() && (box.max.array() <= held.max.array()).all();
}

void NeighborBoxes::keep_apart(std::vector<BodyPair> pairs) {
    if (pairs == apart_) return;
    apart_.swap(pairs);
    for (const auto* changed : {&pairs, &apart_})
        for (const BodyPair& pair : *changed)
            for (const std::uint32_t body : {pair.a, pair.b})
                if (known(body)) enclose(body, Bounds(tree_.box(body)));
}

void NeighborBoxes::enclose(std::uint32_t body, const Bounds& box) {
    tree_.set(body, box);
    found_.clear();
    tree_.query(box, stack_, [&](std::uint32_t other) {
        if (other != body) found_.push_back(other);
    });
    const auto drop_apart = [&](std::vector<std::uint32_t>& list) {
        if (apart_.empty() && filters_.empty()) return;
        std::erase_if(list, [&](std::uint32_t other) {
            const BodyPair pair{std::min(body, other), std::max(body, other)};
            return filters_.keep_apart(pair) || std::binary_search(apart_.begin(), apart_.end(), pair);
        });
    };
    drop_apart(found_);
    std::sort(found_.begin(), found_.end());
    std::vector<std::uint32_t>& mine = moving_[body];
    for (const std::uint32_t other : mine) {
        if (std::binary_search(found_.begin(), found_.end(), other)) continue;
        auto& theirs = moving_[other];
        const auto place = std::lower_bound(theirs.begin(), theirs.end(), body);
        if (place != theirs.end() && *place == body) theirs.erase(place);
    }
    for (const std::uint32_t other : found_) {
        auto& theirs = moving_[other];
        const auto place = std::lower_bound(theirs.begin(), theirs.end(), body);
        if (place == theirs.end() || *place != body) theirs.insert(place, body);
    }
    mine.swap(found_);
    std::vector<std::uint32_t>& standing = standing_[body];
    standing = half_spaces_;
    fixed_tree_.query(box, [&](std::uint32_t k) { standing.push_back(fixed_[k]); });
    drop_apart(standing);
    std::sort(standing.begin(), standing.end());
}

}  // namespace tumble
