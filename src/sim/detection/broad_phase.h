// Broad phase: finds the pairs of bodies that may touch. It holds a tree over the fattened bounds of the moving bodies,
// one over the sleeping bodies, one over the fixed bodies, and a list of the half-spaces. A body that leaves its fat
// bounds moves in its tree alone. The list of pairs is kept, and changes where a body left its bounds, fell asleep or
// woke.
//
// Sleeping bodies cost nothing: only awake bodies are visited, in trees that are small where few are awake, and pairs
// of two sleeping bodies are not in the list. The update detects that a body falls asleep, but not that one wakes,
// because it does not visit sleeping bodies: see bodies_woke().
#pragma once

#include "sim/detection/layer_filters.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/body_pair.h"
#include "sim/geometry/dynamic_tree.h"
#include "sim/math/bounds_tree.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class BroadPhase {
public:
    using Pair = BodyPair;  // at least one body is dynamic
    /// awake: pairs with an awake body, for the step. all: pairs of sleeping bodies as well.
    enum class Pairs { awake, all };

    explicit BroadPhase(Pairs kind = Pairs::awake) : kind_(kind) {}

    /// The pairs for the bodies' present poses and speeds, ascending: all whose bounds_of_step overlap. h: the step, s.
    /// Precondition: the same bodies in every call. `pool`: visits the bodies and searches with all its threads.
    const std::vector<Pair>& update(const std::vector<Body>& bodies, double h, ThreadPool* pool = nullptr);

    /// Pairs that are never found, ascending. Pairs of the last call are found again.
    void keep_apart(std::vector<Pair> pairs);

    /// Bodies have vanished or appeared (Body::absent), or have other shapes: `changed`, ascending.
    void exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed);

    /// Must be called when any body's `asleep` has been cleared: the next update then finds all awake bodies.
    void bodies_woke() { search_awake_ = true; }

    /// Moving bodies that are awake or ballistic, ascending, as of the last update.
    const std::vector<std::uint32_t>& awake() const { return awake_; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [kind, built, search_awake, fixed, half_spaces, awake, fixed_tree, active_tree, resting_tree, states,
               moved, searches, fell_asleep, pairs, added, spare, apart, filters] = self;
        archive.rebuilt(kind, built, fixed, half_spaces, fixed_tree, search_awake, awake, moved, fell_asleep, filters);
        archive.keep(active_tree, resting_tree, pairs, apart);
        archive.by_body_or_none(states);
        archive.scratch(searches, added, spare);
        archive.require([&] { return self.sound(); });
    }

private:
    /// True if each body is in the tree that its state names, and the pairs are in order.
    bool sound() const;
    bool kept_apart(const Pair& pair) const {
        return filters_.keep_apart(pair) || std::binary_search(apart_.begin(), apart_.end(), pair);
    }
    void build(const std::vector<Body>& bodies);
    void list_fixed(const std::vector<Body>& bodies);
    void find_awake(const std::vector<Body>& bodies);
    bool stays(std::uint32_t i, const Body& body, double h);
    void find_leavers(const std::vector<Body>& bodies, double h, ThreadPool& pool);
    void visit(std::uint32_t i, const Body& body, double h);
    bool active(const Body& body) const { return (!body.asleep || kind_ == Pairs::all) && !body.flying; }
    // Results of one thread.
    struct Search {
        std::vector<std::uint32_t> leavers;
        std::vector<Pair> pairs;
        DynamicTree::Stack stack;
    };
    void find_added(const std::vector<Body>& bodies, ThreadPool* pool);
    void find_pairs_of(std::uint32_t i, const std::vector<Body>& bodies, Search& search) const;

    Pairs kind_;
    bool built_ = false, search_awake_ = true;
    std::vector<std::uint32_t> fixed_, half_spaces_, awake_;
    BoundsTree fixed_tree_;
    DynamicTree active_tree_, resting_tree_;  // each body is in one of them, according to its state
    struct State {
        bool active = false;        // awake and not ballistic
        bool moved = false;         // left its bounds in this update: its pairs are searched anew
        double displacement = 0.0;  // m, lookahead of its fat bounds
        // Pose of the last computation of its bounds, and their distance (m) inside the fat ones.
        Vec3 position = Vec3::Zero();
        Quat orientation = Quat::Identity();
        double room = -1.0;
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [active, moved, displacement, position, orientation, room] = self;
            archive.keep(active, displacement, position, orientation, room);
            archive.scratch(moved);
        }
    };
    std::vector<State> states_;  // by body
    std::vector<std::uint32_t> moved_;
    std::vector<Search> searches_;  // by thread
    bool fell_asleep_ = false;
    std::vector<Pair> pairs_, added_, spare_;
    std::vector<Pair> apart_;  // ascending: not found
    LayerFilters filters_;     // since build()
};

/// Bounds of the body in a step of h seconds at its present velocities, grown by a fraction of its size.
Bounds bounds_of_step(const Body& body, double h);

}  // namespace tumble
