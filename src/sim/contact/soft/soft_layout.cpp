#include "sim/contact/soft/soft_layout.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/joints/joint.h"

#include <algorithm>
#include <atomic>
#include <bit>

namespace tumble {
namespace {

constexpr std::size_t joint_colors = 64;  // bits of a mask; a joint without a free color is solved one by one
using soft::joint_kinds;

}  // namespace

// Greedy coloring in the joints' order, as SoftLayout::color().
void JointLayout::color(std::span<const Place> places, std::size_t slots, std::size_t homes, std::size_t lanes) {
    taken_.assign(slots, {});
    class_.resize(places.size());
    at_.assign(homes * joint_colors * joint_kinds, 0);
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& place = places[k];
        const bool across = place.home + 1 == homes;
        std::uint64_t fixed_a = 0, fixed_b = 0;
        const auto colors_of = [&](std::uint32_t slot, std::uint64_t& fixed) -> std::uint64_t& {
            return slot == 0 ? fixed : across ? taken_[slot].across : taken_[slot].inside;
        };
        std::uint64_t &of_a = colors_of(place.slot_a, fixed_a), &of_b = colors_of(place.slot_b, fixed_b);
        const auto c = std::size_t(std::countr_one(of_a | of_b));
        if (c == joint_colors) {
            class_[k] = none;
            continue;
        }
        of_a |= std::uint64_t(1) << c;
        of_b |= std::uint64_t(1) << c;
        class_[k] = std::uint32_t((place.home * joint_colors + c) * joint_kinds + std::size_t(place.kind));
        ++at_[class_[k]];
    }
    std::size_t groups = 0;
    first_group_.clear();
    first_color_.assign(1, 0);
    kinds_.clear();
    for (std::size_t home = 0; home < homes; ++home) {
        for (std::size_t c = 0; c < joint_colors; ++c) {
            const std::size_t first = groups;
            for (std::size_t kind = 0; kind < joint_kinds; ++kind) {
                std::uint32_t& of_class = at_[(home * joint_colors + c) * joint_kinds + kind];
                const std::size_t needed = (of_class + lanes - 1) / lanes;
                of_class = std::uint32_t(groups * lanes);
                groups += needed;
                kinds_.resize(groups, soft::JointKind(kind));
            }
            if (groups > first) first_group_.push_back(first);
        }
        if (home + 1 < homes) first_color_.push_back(first_group_.size());
    }
    for (std::size_t k = 0; k < places.size(); ++k)
        if (class_[k] == none) {
            first_group_.push_back(groups++);
            kinds_.push_back(places[k].kind);
        }
    first_color_.push_back(first_group_.size());
    first_group_.push_back(groups);

    angular_indices_.resize(groups);
    turning_ = 0;
    for (std::size_t g = 0; g < groups; ++g) {
        angular_indices_[g] = std::uint32_t(turning_);
        turning_ += soft::turns(kinds_[g]);
    }

    lane_joints_.assign(groups * lanes, none);
    std::size_t alone = groups * lanes;
    for (std::size_t k = places.size(); k-- > 0;)
        if (class_[k] == none) lane_joints_[alone -= lanes] = std::uint32_t(k);
    for (std::size_t k = 0; k < places.size(); ++k)
        if (class_[k] != none) lane_joints_[at_[class_[k]]++] = std::uint32_t(k);
}

namespace {

constexpr std::size_t colors = 64;  // bits of a mask; a manifold without a free color is solved after all others
// Manifolds of a color are grouped by cost: first manifolds with impulses, then manifolds without, which may stay idle,
// and by their number of points: no lane waits for another's fourth.
constexpr std::size_t costs = 2 * Manifold::capacity;
std::size_t cost_class(const Manifold& m) {
    return std::size_t(Manifold::capacity - m.count) + (normal_impulse(m) > 0.0 ? 0 : Manifold::capacity);
}

// May be called by any thread; writes only a change, because all threads read the neighboring flags.
void set(std::uint8_t& flag) {
    const std::atomic_ref shared(flag);
    if (shared.load(std::memory_order_relaxed) == 0) shared.store(1, std::memory_order_relaxed);
}

}  // namespace

SoftLayout::Mover SoftLayout::mover(const std::vector<Body>& bodies, std::uint32_t body, std::uint32_t manifold) {
    return {body, bodies[body].angular_velocity.isZero(0.0) ? none : manifold};
}

void SoftLayout::open(const IslandBatch& batch, const std::vector<Body>& bodies, std::vector<std::uint32_t>& slot,
                      std::size_t team) {
    blocks_.clear();
    islands_.clear();
    const std::size_t dynamic = 1 + batch.bodies.size();  // number of slots
    block_of_.resize(dynamic);
    island_of_.resize(dynamic);
    lasts_ = true;
    steps_ = 0;
    std::size_t first = 0;
    for (const std::size_t end : batch.island_ends) {
        const std::size_t first_block = blocks_.size();
        blocks_.add(std::span(batch.bodies).subspan(first, end - first), bodies);
        std::fill(island_of_.begin() + std::ptrdiff_t(first + 1), island_of_.begin() + std::ptrdiff_t(end + 1),
                  std::uint32_t(islands_.size()));
        islands_.push_back({.first = first, .end = end, .first_block = first_block, .end_block = blocks_.size()});
        lasts_ = lasts_ && blocks_.size() <= first_block + 1;
        first = end;
    }
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (std::size_t k = blocks_.first(b); k < blocks_.first(b + 1); ++k) {
            slot[blocks_.order()[k]] = std::uint32_t(k + 1);
            block_of_[k + 1] = std::uint32_t(b);
        }
    taken_.assign(dynamic, {});
    class_size_.assign((blocks_.size() + 1) * colors * costs, 0);
    class_.resize(batch.manifolds.size());
    found_movers_.assign(team, {});
}

// Greedy coloring in the manifolds' order: the lowest color that neither body has, inside the blocks and between them.
// The colors of a body depend on its island alone. Each thread colors its own blocks, whose manifolds its core's cache
// holds, and one thread the manifolds between blocks.
void SoftLayout::color(const IslandBatch& batch, const std::vector<Body>& bodies,
                       const std::vector<Manifold>& manifolds, const std::vector<std::uint32_t>& slot,
                       std::size_t thread, std::size_t team) {
    const Share own = blocks_of(thread, team);
    const std::size_t across = blocks_.size();
    for (std::size_t k = 0; k < batch.pairs.size(); ++k) {
        const std::uint32_t a = slot[batch.pairs[k].a], b = slot[batch.pairs[k].b];  // 0: not dynamic
        const bool inside = a == 0 || b == 0 || block_of_[a] == block_of_[b];
        const std::size_t home = inside ? block_of_[a != 0 ? a : b] : across;
        if (inside ? home < own.begin || home >= own.end : thread + 1 < team) continue;
        if (a == 0 || b == 0) {
            Island& island = islands_[island_of_[a != 0 ? a : b]];
            const std::uint32_t other = a != 0 ? batch.pairs[k].b : batch.pairs[k].a;
            set(bodies[other].moves() ? island.driven : island.touches_static);
            if (bodies[other].type == BodyType::kinematic)
                found_movers_[thread].push_back(mover(bodies, other, batch.manifolds[k]));
        }
        std::uint64_t fixed = 0;
        std::uint64_t& of_a = a == 0 ? fixed : inside ? taken_[a].inside : taken_[a].across;
        std::uint64_t& of_b = b == 0 ? fixed : inside ? taken_[b].inside : taken_[b].across;
        const auto c = std::size_t(std::countr_one(of_a | of_b));
        if (c == colors) {  // add_rest()
            class_[k] = none;
            continue;
        }
        const std::uint64_t bit = std::uint64_t(1) << c;
        of_a |= bit;
        of_b |= bit;
        class_[k] = std::uint32_t((home * colors + c) * costs + cost_class(manifolds[batch.manifolds[k]]));
        ++class_size_[class_[k]];
    }
}

void SoftLayout::add_joints(const IslandBatch& batch, const AllJoints& all, const std::vector<Body>& bodies,
                            const std::vector<std::uint32_t>& slot, std::size_t lanes) {
    joint_places_.clear();
    joint_ends_.clear();
    joint_movers_.clear();
    for (const std::uint32_t k : batch.joints) {
        const Joint& joint = all.joints[k];
        const auto place = std::uint32_t(joint_places_.size());
        const auto slot_of = [&](std::uint32_t body) {  // 0: not moved by impulses
            return body != Joint::world && bodies[body].dynamic() ? slot[body] : 0u;
        };
        const std::uint32_t a = slot_of(joint.a), b = slot_of(joint.b);
        const bool inside = a == 0 || b == 0 || block_of_[a] == block_of_[b];
        const auto home = std::uint32_t(inside ? block_of_[a != 0 ? a : b] : blocks_.size());
        joint_places_.push_back({a, b, home, all.kinds[k]});
        joint_ends_.push_back({a, b, a != 0, b != 0});
        if (a != 0 && b != 0) continue;
        Island& island = islands_[island_of_[a != 0 ? a : b]];
        const std::uint32_t other = a != 0 ? joint.b : joint.a;
        if (other == Joint::world || !bodies[other].moves()) {
            island.touches_static = 1;
            continue;
        }
        island.driven = 1;
        joint_movers_.push_back({place, other, a != 0});
        found_movers_[0].push_back({other, none});
    }
    joints_.color(joint_places_, 1 + blocks_.order().size(), blocks_.size() + 1, lanes);
}

void SoftLayout::close(const IslandBatch& batch, const std::vector<std::uint32_t>& slot, std::size_t lanes) {
    movers_.clear();
    for (const std::vector<Mover>& found : found_movers_) movers_.insert(movers_.end(), found.begin(), found.end());
    std::sort(movers_.begin(), movers_.end());
    movers_.erase(std::unique(movers_.begin(), movers_.end()), movers_.end());
    lasts_ = lasts_ && movers_.empty();
    if (!batch.joints.empty())
        for (const auto& [place, body, second] : joint_movers_) {
            const auto found = std::lower_bound(movers_.begin(), movers_.end(), Mover{body, none}) - movers_.begin();
            (second ? joint_ends_[place].slot_b : joint_ends_[place].slot_a) =
                std::uint32_t(1 + blocks_.order().size() + std::size_t(found));
        }

    const std::size_t homes = blocks_.size() + 1;
    std::size_t groups = 0;
    first_group_.clear();
    first_color_.assign(1, 0);
    for (std::size_t home = 0; home < homes; ++home) {
        for (std::size_t c = 0; c < colors; ++c) {
            std::uint32_t lane = std::uint32_t(groups * lanes);
            for (std::size_t p = 0; p < costs; ++p) {  // sizes become positions
                std::uint32_t& of_class = class_size_[(home * colors + c) * costs + p];
                const std::uint32_t size = of_class;
                of_class = lane;
                lane += size;
            }
            if (lane == groups * lanes) continue;
            first_group_.push_back(groups);
            groups = (lane + lanes - 1) / lanes;
        }
        if (home + 1 < homes) first_color_.push_back(first_group_.size());
    }
    first_group_.push_back(groups);
    lane_manifolds_.assign(groups * lanes, none);
    for (std::size_t i = 0; i < class_.size(); ++i)
        if (class_[i] != none) lane_manifolds_[class_size_[class_[i]]++] = batch.manifolds[i];
    add_rest(batch, slot, lanes);
    first_color_.push_back(first_group_.size() - 1);
}

// The manifolds without a free color follow as if solved one by one in their order: each has the first color after
// those of all earlier ones that share a body with it. Between others the order makes no difference.
void SoftLayout::add_rest(const IslandBatch& batch, const std::vector<std::uint32_t>& slot, std::size_t lanes) {
    std::vector<std::vector<std::uint32_t>> rest;    // by color: manifolds
    std::vector<std::uint32_t> next(taken_.size());  // by slot: the first color after those of its manifolds
    for (std::size_t i = 0; i < class_.size(); ++i) {
        if (class_[i] != none) continue;
        const std::uint32_t a = slot[batch.pairs[i].a], b = slot[batch.pairs[i].b];  // 0: not dynamic
        const std::uint32_t color = std::max(a != 0 ? next[a] : 0u, b != 0 ? next[b] : 0u);
        next[a] = next[b] = color + 1;
        if (color == rest.size()) rest.emplace_back();
        rest[color].push_back(batch.manifolds[i]);
    }
    for (const std::vector<std::uint32_t>& color : rest) {
        lane_manifolds_.insert(lane_manifolds_.end(), color.begin(), color.end());
        lane_manifolds_.resize((lane_manifolds_.size() + lanes - 1) / lanes * lanes, none);
        first_group_.push_back(lane_manifolds_.size() / lanes);
    }
}

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

// The items are ascending by body, in each half too.
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
