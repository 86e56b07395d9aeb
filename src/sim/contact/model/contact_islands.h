// Islands: sets of dynamic bodies connected by manifolds. Within a step islands cannot affect each other, so they are
// solved independently, on any thread, and fall asleep as a whole. The cost scales with the awake bodies only.
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

    /// Islands of the manifolds, ordered by their lowest body.
    /// - `touching`: the body pairs of the manifolds.
    /// - `awake`: the bodies that take part, ascending: dynamic, not asleep, not ballistic.
    /// Other bodies belong to no island and connect none. Manifolds without a body that takes part, and bodies without
    /// manifolds, are skipped. The same pairs and the same awake bodies give the same islands.
    /// - `joined`: the bodies of the joints that hold; UINT32_MAX for the world. They connect as manifolds do.
    void find(std::span<const BodyPair> touching, const std::vector<Body>& bodies, std::span<const std::uint32_t> awake,
              std::span<const BodyPair> joined = {});

    /// Number of times the islands were rebuilt: equal numbers mean the same islands.
    std::uint64_t changes() const { return round_; }

    std::size_t size() const { return first_body_.size() - 1; }
    /// Bodies of all islands, one island after the other.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    std::span<const std::uint32_t> bodies(std::size_t island) const {
        return std::span(bodies_).subspan(first_body_[island], first_body_[island + 1] - first_body_[island]);
    }
    std::span<const std::uint32_t> manifolds(std::size_t island) const {
        return std::span(manifolds_)
            .subspan(first_manifold_[island], first_manifold_[island + 1] - first_manifold_[island]);
    }
    /// The island's joints, ascending: indices into `joined`.
    std::span<const std::uint32_t> joints(std::size_t island) const {
        if (joints_.empty()) return {};
        return std::span(joints_).subspan(first_joint_[island], first_joint_[island + 1] - first_joint_[island]);
    }
    bool any_joints() const { return !joints_.empty(); }
    /// Body pairs of the island's manifolds, in the same order.
    std::span<const BodyPair> pairs(std::size_t island) const {
        return std::span(pairs_).subspan(first_manifold_[island],
                                         first_manifold_[island + 1] - first_manifold_[island]);
    }
    /// A manifold whose bodies meet in further manifolds too. Bodies that contacts do not move count as one: `second`
    /// is UINT32_MAX for all of them.
    struct Repeated {
        std::uint32_t first, second, manifold;
        auto operator<=>(const Repeated&) const = default;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [first, second, manifold] = self;
            archive.keep(first, second, manifold);
        }
    };
    /// Repeated manifolds of all islands, ascending.
    std::span<const Repeated> repeated() const { return repeated_; }
    /// Number of body pairs that touch; a pair of compounds or meshes may have many manifolds.
    std::size_t touching_pairs(std::size_t island) const { return touching_pairs_[island]; }
    /// True if the island touches only its own bodies.
    bool is_free(std::size_t island) const { return free_[island] != 0; }

private:
    // still: not moved by contacts. aside: asleep or ballistic, not affected by the contacts of this step.
    enum class Role : std::uint8_t { still, takes_part, aside };
    Role role_of(std::uint32_t i, const std::vector<Body>& bodies);
    std::uint32_t root(std::uint32_t i);
    std::uint32_t connect(std::uint32_t a, std::uint32_t b, const std::vector<Body>& bodies);
    void list_repeated(std::uint32_t place, bool still_a, bool still_b, bool same_pair);
    void list_joints(std::span<const BodyPair> joined);

    // Per body; valid where `round` is the present one.
    struct Member {
        std::uint64_t round = 0;
        std::uint32_t parent = 0, island = 0;
        Role role = Role::still;
        bool touched = false;
        std::uint32_t on_still = UINT32_MAX;  // its last manifold with a body that contacts do not move
    };
    std::vector<Member> members_;
    std::vector<std::uint32_t> held_;         // by manifold: index of one of its bodies that takes part
    std::vector<std::uint32_t> held_joints_;  // by joint: the same
    std::uint64_t round_ = 0;
    std::vector<std::uint32_t> bodies_, manifolds_, first_body_{0}, first_manifold_{0};
    std::vector<BodyPair> pairs_;                // in the order of manifolds_
    std::vector<std::uint32_t> touching_pairs_;  // by island
    std::vector<std::uint8_t> free_;
    std::vector<Repeated> repeated_;
    std::vector<std::uint32_t> joints_, first_joint_;  // empty without joints
};

}  // namespace tumble
