#include "sim/contact/model/contact_islands.h"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

constexpr std::uint32_t no_island = UINT32_MAX;

}  // namespace

ContactIslands::ContactIslands(std::size_t bodies) : members_(bodies) {}

// Reads only bodies that may take part: bodies lie far apart in memory.
ContactIslands::Role ContactIslands::role_of(std::uint32_t i, const std::vector<Body>& bodies) {
    Member& member = members_[i];
    if (member.round != round_) member = {.round = round_, .role = bodies[i].dynamic() ? Role::aside : Role::still};
    return member.role;
}

// Union-find with path halving; the lower index is the root.
std::uint32_t ContactIslands::root(std::uint32_t i) {
    while (members_[i].parent != i) i = members_[i].parent = members_[members_[i].parent].parent;
    return i;
}

// Returns one of the two bodies that takes part, or `no_island`.
std::uint32_t ContactIslands::connect(std::uint32_t a, std::uint32_t b, const std::vector<Body>& bodies) {
    const auto role = [&](std::uint32_t i) { return i == UINT32_MAX ? Role::still : role_of(i, bodies); };
    const Role role_a = role(a), role_b = role(b);
    if (role_a == Role::aside || role_b == Role::aside) return no_island;
    std::uint32_t held = no_island;
    for (const auto& [i, its_role] : {std::pair(a, role_a), std::pair(b, role_b)}) {
        if (its_role != Role::takes_part) continue;
        members_[i].touched = true;
        held = i;
    }
    if (role_a != Role::takes_part || role_b != Role::takes_part) return held;
    const std::uint32_t i = root(a), j = root(b);
    members_[std::max(i, j)].parent = std::min(i, j);
    return held;
}

void ContactIslands::find(std::span<const BodyPair> touching, const std::vector<Body>& bodies,
                          std::span<const std::uint32_t> awake, std::span<const BodyPair> joined) {
    ++round_;
    for (const std::uint32_t i : awake)
        members_[i] = {.round = round_, .parent = i, .island = no_island, .role = Role::takes_part};
    held_.assign(touching.size(), no_island);
    for (std::size_t k = 0; k < touching.size(); ++k) {
        held_[k] = connect(touching[k].a, touching[k].b, bodies);
    }
    held_joints_.assign(joined.size(), no_island);
    for (std::size_t k = 0; k < joined.size(); ++k) held_joints_[k] = connect(joined[k].a, joined[k].b, bodies);
    // Numbers the islands by their lowest body, counts, then fills the lists.
    first_body_.assign(1, 0);
    first_manifold_.assign(1, 0);
    for (const std::uint32_t i : awake) {
        if (!members_[i].touched) continue;
        std::uint32_t& number = members_[root(i)].island;
        if (number == no_island) {
            number = std::uint32_t(first_body_.size() - 1);
            first_body_.push_back(0);
            first_manifold_.push_back(0);
        }
        members_[i].island = number;
        ++first_body_[number + 1];
    }
    const auto island_of = [&](std::size_t k) { return held_[k] == no_island ? no_island : members_[held_[k]].island; };
    for (std::size_t k = 0; k < touching.size(); ++k)
        if (const std::uint32_t number = island_of(k); number != no_island) ++first_manifold_[number + 1];
    for (std::size_t k = 1; k < first_body_.size(); ++k) {
        first_body_[k] += first_body_[k - 1];
        first_manifold_[k] += first_manifold_[k - 1];
    }
    bodies_.resize(first_body_.back());
    manifolds_.resize(first_manifold_.back());
    std::vector<std::uint32_t> next_body = first_body_, next_manifold = first_manifold_;
    for (const std::uint32_t i : awake)
        if (members_[i].touched) bodies_[next_body[members_[i].island]++] = i;
    pairs_.resize(manifolds_.size());
    touching_pairs_.assign(size(), 0);
    free_.assign(size(), 1);
    repeated_.clear();
    for (std::uint32_t k = 0; k < touching.size(); ++k) {
        const std::uint32_t number = island_of(k);
        if (number == no_island) continue;
        const std::uint32_t place = next_manifold[number]++;
        manifolds_[place] = k;
        pairs_[place] = touching[k];
        const bool same = place != first_manifold_[number] && pairs_[place - 1] == touching[k];
        if (!same) ++touching_pairs_[number];
        const bool still_a = members_[touching[k].a].role == Role::still,
                   still_b = members_[touching[k].b].role == Role::still;
        if (still_a || still_b) free_[number] = 0;
        if (same || still_a || still_b) list_repeated(place, still_a, still_b, same);
    }
    std::sort(repeated_.begin(), repeated_.end());
    repeated_.erase(std::unique(repeated_.begin(), repeated_.end()), repeated_.end());
    list_joints(joined);
}

// Lists a manifold and the one before it with the same two bodies. `place`: in manifolds_.
void ContactIslands::list_repeated(std::uint32_t place, bool still_a, bool still_b, bool same_pair) {
    const auto [a, b] = pairs_[place];
    if (!still_a && !still_b) {
        if (!same_pair) return;
        repeated_.push_back({a, b, manifolds_[place - 1]});
        repeated_.push_back({a, b, manifolds_[place]});
        return;
    }
    const std::uint32_t moved = still_a ? b : a;
    const std::uint32_t last = std::exchange(members_[moved].on_still, manifolds_[place]);
    if (last == UINT32_MAX) return;
    repeated_.push_back({moved, UINT32_MAX, last});
    repeated_.push_back({moved, UINT32_MAX, manifolds_[place]});
}

void ContactIslands::list_joints(std::span<const BodyPair> joined) {
    joints_.clear();
    if (joined.empty()) return;
    const auto island_of = [&](std::size_t k) {
        return held_joints_[k] == no_island ? no_island : members_[held_joints_[k]].island;
    };
    first_joint_.assign(first_body_.size(), 0);
    for (std::size_t k = 0; k < joined.size(); ++k)
        if (const std::uint32_t number = island_of(k); number != no_island) ++first_joint_[number + 1];
    for (std::size_t k = 1; k < first_joint_.size(); ++k) first_joint_[k] += first_joint_[k - 1];
    joints_.resize(first_joint_.back());
    std::vector<std::uint32_t> next = first_joint_;
    for (std::uint32_t k = 0; k < joined.size(); ++k) {
        const std::uint32_t number = island_of(k);
        if (number == no_island) continue;
        joints_[next[number]++] = k;
        for (const std::uint32_t i : {joined[k].a, joined[k].b})
            if (i == UINT32_MAX || members_[i].role == Role::still) free_[number] = 0;
    }
}

}  // namespace tumble
