// The velocities that move the poses in a step, and the fractions of the step for which CCD lets the bodies move.
#pragma once

#include "sim/ccd/ccd_clamp.h"
#include "sim/step/contact_detection.h"
#include "sim/step/step_context.h"
#include "sim/threads/thread_pool.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

class ClampedMotions {
public:
    explicit ClampedMotions(const std::vector<Body>& bodies) : clamp_(bodies) {}

    /// Fills BodySet::motions: motion_of(i, body) for every moving body, on the body's thread. Throws RunError for a
    /// state that is not finite: all must be finite before CCD.
    template <class MotionOf>
    void find(const StepContext& step, MotionOf&& motion_of) {
        any_fast_ = false;
        BodySet& set = step.set;
        step.pool.for_bodies(set.moving, tuning::parallel_bodies, [&](std::uint32_t i) {
            step.check.examine(i, set.bodies);
            BodyVelocity& motion = set.motions[i];
            motion = motion_of(i, std::as_const(set.bodies[i]));
            if (clamp_.fast(i, motion, step.h) && !any_fast_) any_fast_ = true;
        });
        stop_if_not_finite(step);
    }

    /// Limits by body. Precondition: find().
    const std::vector<CcdFraction>& limits(const StepContext& step, ContactDetection& detection,
                                           const FindPairs& find_pairs, const TurnsFreely& turns_freely = nullptr) {
        const std::vector<Manifold>& manifolds = detection.manifolds();
        const auto& limits =
            clamp_.limits({step.set.bodies, step.set.motions, step.h, any_fast_, turns_freely, known_apart(manifolds)},
                          find_pairs, touch_depth(manifolds, step.set.bodies));
        clamped_islands_.clear();
        return any_fast_ && detection.islands().any_joints() ? joined(limits, detection.islands()) : limits;
    }
    /// Islands with joints that move for a fraction of the step, by the last limits().
    std::span<const std::size_t> clamped_islands() const { return clamped_islands_; }

    /// Bodies have other shapes.
    void measure(const std::vector<Body>& bodies, std::span<const std::uint32_t> changed) {
        for (const std::uint32_t i : changed) clamp_.measure(i, bodies[i]);
    }
    void measure(const std::vector<Body>& bodies) { clamp_.measure(bodies); }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [clamp, any_fast, joined, clamped_islands] = self;
        archive.keep(clamp);
        archive.scratch(any_fast, joined, clamped_islands);
    }

private:
    /// Joined bodies move for the same fraction of the step: otherwise their joints would open.
    const std::vector<CcdFraction>& joined(const std::vector<CcdFraction>& limits, const ContactIslands& islands) {
        joined_ = limits;
        for (std::size_t k = 0; k < islands.size(); ++k) {
            if (islands.joints(k).empty()) continue;
            double share = 1.0;
            for (const std::uint32_t i : islands.bodies(k)) share = std::min(share, limits[i].share);
            if (share == 1.0) continue;
            clamped_islands_.push_back(k);
            for (const std::uint32_t i : islands.bodies(k)) joined_[i] = {.share = share};
        }
        return joined_;
    }

    CcdClamp clamp_;
    std::vector<CcdFraction> joined_;    // by body
    std::atomic<bool> any_fast_{false};  // set by each body's own thread
    std::vector<std::size_t> clamped_islands_;
};

}  // namespace tumble
