// Contact detection of a step: broad phase, manifolds, islands. Wakes the bodies that are touched.
#pragma once

#include "sim/contact/model/contact_islands.h"
#include "sim/detection/broad_phase.h"
#include "sim/detection/narrow_phase.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tumble {

class MotionStage;
struct StepContext;

class ContactDetection {
public:
    /// `memory`: off computes all manifolds anew. Exact energies need exact manifolds: points a thousandth off make
    /// nanometers of height.
    ContactDetection(std::size_t bodies, int threads, NarrowPhase::Memory memory)
        : narrow_phase_(threads, NarrowPhase::Mode::step, memory), islands_(bodies) {}

    /// Finds the contacts of the present poses, where they are out of date.
    void update(const StepContext& step, MotionStage& motion);
    /// To be called when bodies have moved, woken or been joined since update().
    void out_of_date() { current_ = false; }

    /// The step's manifolds, ascending by body; the solvers write into them. Precondition: update().
    std::vector<Manifold>& manifolds() { return narrow_phase_.manifolds(); }
    const ContactIslands& islands() const { return islands_; }

    /// Pairs of bodies that do not collide, ascending.
    void keep_apart(std::vector<BodyPair> pairs) { broad_phase_.keep_apart(std::move(pairs)); }

    /// See BroadPhase::exchange().
    void exchange(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed) {
        broad_phase_.exchange(bodies, changed);
        narrow_phase_.forget(changed);
        current_ = false;
    }

    /// The pairs that may meet in the step, at the bodies' present velocities.
    const std::vector<BroadPhase::Pair>& find_pairs(const StepContext& step);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [broad_phase, narrow_phase, current, islands, seen_by_islands] = self;
        archive.keep(broad_phase, narrow_phase, current);
        archive.rebuilt(islands, seen_by_islands);  // found in the first step, of the same pairs
    }

private:
    void find(const StepContext& step);

    BroadPhase broad_phase_;
    NarrowPhase narrow_phase_;
    bool current_ = false;    // update() has found the contacts of the present poses
    ContactIslands islands_;  // of the stepped bodies
    // Change counters of the manifolds, of sleep and of joints at which the islands were found.
    std::array<std::uint64_t, 3> seen_by_islands_{UINT64_MAX, UINT64_MAX, UINT64_MAX};
};

}  // namespace tumble
