// Which bodies may touch: a tree over the fattened bounds of the bodies that move, one over those that sleep, one over the
// fixed bodies, and a list of the half-spaces. A body that leaves its fat bounds moves in its tree alone; the list of pairs is
// kept, and changes where somebody left, fell asleep or woke.
//
// Sleeping bodies cost nothing: only those awake are visited, among trees that are small where few are awake, and pairs of
// two sleeping ones are not in the list. A body that falls asleep is noticed; who wakes is not, since nobody looks at
// sleepers: see bodies_woke().
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/body_pair.h"
#include "sim/geometry/bounds_tree.h"
#include "sim/geometry/dynamic_tree.h"
#include "sim/threads/thread_pool.h"

#include <cstdint>
#include <vector>

namespace tumble {

class BroadPhase {
public:
    using Pair = BodyPair;   // at least one is dynamic
    /// awake: pairs of which one body is awake, for the step. all: sleepers among themselves as well.
    enum class Pairs { awake, all };

    explicit BroadPhase(Pairs kind = Pairs::awake) : kind_(kind) {}

    /// The pairs for the bodies' present poses and speeds, ascending: all whose bounds_of_step overlap. h: the step, s. The
    /// bodies must be the same ones in every call. `pool`: looks the bodies over and searches with all its threads.
    const std::vector<Pair>& update(const std::vector<Body>& bodies, double h, ThreadPool* pool = nullptr);

    /// To be called when any body's `asleep` has been cleared: the next update looks for all that are awake.
    void bodies_woke() { look_for_awake_ = true; }

    /// Bodies that move and are awake or in exact flight, ascending, as of the last update.
    const std::vector<std::uint32_t>& awake() const { return awake_; }

private:
    void build(const std::vector<Body>& bodies);
    void find_awake(const std::vector<Body>& bodies);
    bool stays(std::uint32_t i, const Body& body, double h);
    void find_leavers(const std::vector<Body>& bodies, double h, ThreadPool& pool);
    void visit(std::uint32_t i, const Body& body, double h);
    bool active(const Body& body) const { return (!body.asleep || kind_ == Pairs::all) && !body.flying; }
    // What one thread finds.
    struct Search {
        std::vector<std::uint32_t> leavers;
        std::vector<Pair> pairs;
        DynamicTree::Stack stack;
    };
    void find_added(const std::vector<Body>& bodies, ThreadPool* pool);
    void find_pairs_of(std::uint32_t i, const std::vector<Body>& bodies, Search& search) const;

    Pairs kind_;
    bool built_ = false, look_for_awake_ = true;
    std::vector<std::uint32_t> fixed_, half_spaces_, awake_;
    BoundsTree fixed_tree_;
    DynamicTree active_tree_, resting_tree_;  // each body in one of them, as its state says
    struct State {
        bool active = false;    // awake and not in exact flight
        bool moved = false;     // in this update: its pairs are looked for anew
        double way = 0.0;       // m, that its fat bounds reach ahead
        // Where it was when its bounds were last worked out, and how far (m) they lay inside of the fat ones.
        Vec3 position = Vec3::Zero();
        Quat orientation = Quat::Identity();
        double room = -1.0;
    };
    std::vector<State> states_;               // of the bodies
    std::vector<std::uint32_t> moved_;
    std::vector<Search> searches_;            // by thread
    bool fell_asleep_ = false;
    std::vector<Pair> pairs_, added_, spare_;
};

/// Where the body can be in a step of h seconds at its present velocities, and a part of its size around that.
Bounds bounds_of_step(const Body& body, double h);

}  // namespace tumble
