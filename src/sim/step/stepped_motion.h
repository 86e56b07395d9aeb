// Time stepping (impacts = "stepped"): all bodies move by the velocities of the step, clamped where they would pass
// through each other. A body without contact is moved by its integrator.
#pragma once

#include "sim/dynamics/integrators/pair_flight.h"
#include "sim/event_driven/free_flights.h"
#include "sim/step/clamped_motions.h"
#include "sim/step/motion_stage.h"

namespace tumble {

class SteppedMotion final : public MotionStage {
public:
    SteppedMotion(const SceneDescription& scene, const BodySet& set, const StepClock& clock);

    std::int64_t skip_steps(const StepContext& step, std::int64_t) override { return step.index; }
    std::span<const std::uint32_t> choose_stepped(const StepContext& step, const std::vector<Manifold>&) override {
        return step.set.awake;
    }
    bool has_ballistic_bodies() const override { return false; }
    double rebound_share() const override;
    void advance(const StepContext& step, ContactDetection& detection) override;
    std::span<const std::size_t> clamped_islands() const override { return motions_.clamped_islands(); }
    void bodies_fell_asleep(const StepContext&) override {}
    void exchange(const StepContext& step, std::span<const std::uint32_t> changed) override {
        motions_.measure(step.set.bodies, changed);
    }
    void measure(const std::vector<Body>& bodies) override { motions_.measure(bodies); }
    void save(CheckpointWriter& writer) const override;
    void restore(CheckpointReader& reader, std::int64_t step) override;

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [motions, free_flights, pair_flight, ends] = self;
        archive.keep(motions, free_flights);
        archive.scratch(pair_flight, ends);
    }

private:
    BodyVelocity motion(std::uint32_t i, const Body& body, const StepContext& step) const;
    void fly_pairs(const std::vector<CcdFraction>& limits, const StepContext& step);
    void move(std::uint32_t i, const CcdFraction& limit, const StepContext& step);

    ClampedMotions motions_;
    FreeFlights free_flights_;      // of bodies with integrator = "exact"
    PairFlight pair_flight_;        // of bodies with forces between each other,
    std::vector<RigidState> ends_;  // to the ends of their motions
};

}  // namespace tumble
