// Joined bodies in a step: decides the way of each island, before the forces, and keeps the states at its end of
// islands that are free.
#pragma once

#include "sim/articulation/island_flight.h"
#include "sim/joints/joint_way.h"
#include "sim/step/contact_detection.h"
#include "sim/step/step_context.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

class JoinedMotion {
public:
    explicit JoinedMotion(SweepRule rule) : rule_(rule) {}

    /// Decides, and flies the bodies that are free: each to its own buffer. Marks them as `placed`.
    void decide(const StepContext& step, ContactDetection& detection);
    /// By island; empty in scenes without joints. Islands without joints have no way.
    std::span<const IslandWay> ways() const { return ways_; }

    /// After the forces and the solve: the momenta of the step's end to the bodies that are free.
    void give_momenta(const StepContext& step) const;
    /// Motion of a body that is `placed`: its velocity along the step, and its state at the end.
    BodyVelocity motion(std::uint32_t body, const BodySet& set, double h) const;
    const RigidState& end(std::uint32_t body) const { return ends_[place_[body]]; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [rule, mechanisms, crowd, ways, flights, flown, ends, place] = self;
        archive.rebuilt(rule, mechanisms);
        archive.keep(crowd);
        archive.scratch(ways, flights, flown, ends, place);
    }

private:
    bool fly(const StepContext& step, ContactDetection& detection, std::size_t island);

    SweepRule rule_;
    Mechanisms mechanisms_;
    FigureCrowd crowd_;
    std::vector<IslandWay> ways_;
    std::vector<std::unique_ptr<IslandFlight>> flights_;  // by lowest body of an island
    std::vector<std::uint32_t> flown_;                    // bodies that are free in this step
    std::vector<RigidState> ends_;                        // of these
    std::vector<std::uint32_t> place_;                    // by body: in flown_
};

}  // namespace tumble
