// Joined bodies in a step: decides the way of each island, before the forces, and flies the islands that are free.
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

    /// Decides, and flies the bodies that are free, which are then placed at the ends of their flights.
    void decide(const StepContext& step, ContactDetection& detection);
    /// By island; empty in scenes without joints. Islands without joints have no way.
    std::span<const IslandWay> ways() const { return ways_; }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [rule, mechanisms, crowd, ways, flights] = self;
        archive.rebuilt(rule, mechanisms);
        archive.keep(crowd);
        archive.scratch(ways, flights);
    }

private:
    bool fly(const StepContext& step, ContactDetection& detection, std::size_t island);

    SweepRule rule_;
    Mechanisms mechanisms_;
    FigureCrowd crowd_;
    std::vector<IslandWay> ways_;
    std::vector<std::unique_ptr<IslandFlight>> flights_;  // by lowest body of an island
};

}  // namespace tumble
