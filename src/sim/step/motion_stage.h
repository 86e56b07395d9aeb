// The part of a step that depends on the impact mode: which bodies are stepped, and how poses advance. Two
// implementations: SteppedMotion (impacts = "stepped") and EventDrivenStage (impacts = "exact").
#pragma once

#include "sim/geometry/manifold.h"
#include "sim/step/contact_detection.h"
#include "sim/step/step_context.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class CheckpointReader;
class CheckpointWriter;

class MotionStage {
public:
    virtual ~MotionStage() = default;

    /// Advances without stepping to the start of step `to`, or less far, while no body needs stepping. Returns the step
    /// reached: that of the context if stepping is needed.
    virtual std::int64_t skip_steps(const StepContext& step, std::int64_t to) = 0;

    /// The bodies that this step's contacts act on, ascending, given all contacts. Bodies that no contact holds any
    /// more may leave the stepped ones here.
    virtual std::span<const std::uint32_t> choose_stepped(const StepContext& step,
                                                          const std::vector<Manifold>& manifolds) = 0;
    /// True if stepped bodies may differ from the awake ones, and bodies move between steps.
    virtual bool has_ballistic_bodies() const = 0;

    /// Smallest speed at which a contact under load may rebound, over the speed that its load gives it in a step.
    virtual double rebound_share() const = 0;

    /// x and q to t_n+1, at the velocities of the solved contacts.
    virtual void advance(const StepContext& step, ContactDetection& detection) = 0;
    /// Islands with joints that CCD has stopped before the end of the step: their joints are not closed.
    virtual std::span<const std::size_t> clamped_islands() const = 0;

    /// Called after bodies have fallen asleep; the context is that of the coming step.
    virtual void bodies_fell_asleep(const StepContext& step) = 0;

    /// Bodies have vanished or appeared, or have other shapes: `changed`, ascending.
    virtual void exchange(const StepContext& step, std::span<const std::uint32_t> changed) = 0;
    /// Bodies have other shapes than those that the world was built with: after a checkpoint has been read.
    virtual void measure(const std::vector<Body>& bodies) = 0;

    /// For checkpoints: see sim/checkpoint/archive.h.
    virtual void save(CheckpointWriter& writer) const = 0;
    /// `step`: at which the state was saved.
    virtual void restore(CheckpointReader& reader, std::int64_t step) = 0;
};

}  // namespace tumble
