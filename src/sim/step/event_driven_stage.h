// Event-driven mode (impacts = "exact") as the motion stage of a step: bodies in contact are stepped, ballistic bodies
// move from event to event (event_driven_motion.h).
#pragma once

#include "sim/contact/model/contact.h"
#include "sim/event_driven/event_driven_motion.h"
#include "sim/step/clamped_motions.h"
#include "sim/step/motion_stage.h"

#include <vector>

namespace tumble {

class EventDrivenStage final : public MotionStage {
public:
    EventDrivenStage(const BodySet& set, const SimulationSettings& settings, double fps)
        : motions_(set.bodies), events_(set.bodies, settings, fps) {}

    std::int64_t skip_steps(const StepContext& step, std::int64_t to) override;
    std::span<const std::uint32_t> choose_stepped(const StepContext& step,
                                                  const std::vector<Manifold>& manifolds) override;
    bool has_ballistic_bodies() const override { return true; }
    double rebound_share() const override { return 0.0; }
    void advance(const StepContext& step, ContactDetection& detection) override;
    std::span<const std::size_t> clamped_islands() const override { return motions_.clamped_islands(); }
    void bodies_fell_asleep(const StepContext& step) override { events_.lay_down(step.set.bodies, step.index); }
    void exchange(const StepContext& step, std::span<const std::uint32_t> changed) override;
    void measure(const std::vector<Body>& bodies) override;
    void save(CheckpointWriter& writer) const override;
    void restore(CheckpointReader& reader, std::int64_t step) override;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [motions, events, contacts, gaps, stepped, pairs] = self;
        archive.keep(motions, events);
        archive.scratch(contacts, gaps, stepped, pairs);
    }

private:
    std::int64_t run_events(const StepContext& step, std::int64_t until);

    ClampedMotions motions_;
    EventDrivenMotion events_;
    std::vector<Contact> contacts_;
    std::vector<Gap> gaps_;               // by contact
    std::vector<std::uint32_t> stepped_;  // bodies, ascending
    std::vector<BroadPhase::Pair> pairs_;
};

}  // namespace tumble
