// Groups of dynamic bodies that hang together through manifolds. What happens in one cannot reach another within a step,
// so islands are solved independently, on any thread, and fall asleep as one. The time taken goes with the bodies that
// are awake, whatever sleeps beside them.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/body_pair.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class ContactIslands {
public:
    explicit ContactIslands(std::size_t bodies);

    /// Islands of the manifolds, ordered by their lowest body. `touching`: whose the manifolds are. `awake`: the bodies that take
    /// part, ascending: dynamic, neither asleep nor in exact flight. Others belong to none and join nothing; manifolds without a
    /// body that takes part, and bodies without manifolds, are left out. The same lists and the same bodies awake give the same islands.
    void find(std::span<const BodyPair> touching, const std::vector<Body>& bodies, std::span<const std::uint32_t> awake);

    /// How often they were found: the same since then.
    std::uint64_t changes() const { return round_; }

    std::size_t size() const { return first_body_.size() - 1; }
    /// Of all islands, one after the other.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    std::span<const std::uint32_t> bodies(std::size_t island) const {
        return std::span(bodies_).subspan(first_body_[island], first_body_[island + 1] - first_body_[island]);
    }
    std::span<const std::uint32_t> manifolds(std::size_t island) const {
        return std::span(manifolds_).subspan(first_manifold_[island], first_manifold_[island + 1] - first_manifold_[island]);
    }
    /// Whose its manifolds are, one by one.
    std::span<const BodyPair> pairs(std::size_t island) const {
        return std::span(pairs_).subspan(first_manifold_[island], first_manifold_[island + 1] - first_manifold_[island]);
    }
    /// How many pairs of bodies touch: parts and triangles may in many manifolds.
    std::size_t touching_pairs(std::size_t island) const { return touching_pairs_[island]; }
    /// Whether it touches nothing but its own bodies.
    bool floats(std::size_t island) const { return floats_[island] != 0; }

private:
    // still: neither held nor moved by contacts. aside: asleep or in exact flight, not held by this step's contacts.
    enum class Role : std::uint8_t { still, takes_part, aside };
    Role look(std::uint32_t i, const std::vector<Body>& bodies);
    std::uint32_t root(std::uint32_t i);

    // By body; valid where `round` says so.
    struct Member {
        std::uint64_t round = 0;
        std::uint32_t parent = 0, island = 0;
        Role role = Role::still;
        bool touched = false;
    };
    std::vector<Member> members_;
    std::vector<std::uint32_t> held_;              // by manifold: a body of it that takes part
    std::uint64_t round_ = 0;
    std::vector<std::uint32_t> bodies_, manifolds_, first_body_{0}, first_manifold_{0};
    std::vector<BodyPair> pairs_;                  // beside manifolds_
    std::vector<std::uint32_t> touching_pairs_;    // by island
    std::vector<std::uint8_t> floats_;
};

}  // namespace tumble
