// Bodies whose motion through the step is known before contacts are solved, so that no solver moves them: joined bodies
// in flight, and bodies that roll. Each ends the step in a known state.
#pragma once

#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/step/body_set.h"

#include <cstdint>
#include <vector>

namespace tumble {

class PlacedBodies {
public:
    /// At the start of a step: no body is placed.
    void clear(std::vector<Body>& bodies) {
        for (const std::uint32_t i : placed_) bodies[i].placed = false;
        placed_.clear();
        ends_.clear();
        index_.resize(bodies.size());
    }
    void place(std::uint32_t body, const RigidState& end, std::vector<Body>& bodies) {
        bodies[body].placed = true;
        index_[body] = std::uint32_t(placed_.size());
        placed_.push_back(body);
        ends_.push_back(end);
    }

    /// After the forces and the solve: the momenta of the step's end.
    void give_momenta(std::vector<Body>& bodies) const {
        for (std::size_t n = 0; n < placed_.size(); ++n) {
            Body& body = bodies[placed_[n]];
            body.momentum = ends_[n].momentum;
            body.angular_momentum = ends_[n].angular_momentum;
            body.derive_velocities();
        }
    }

    const RigidState& end(std::uint32_t body) const { return ends_[index_[body]]; }
    /// Mean velocities along the step of h seconds.
    BodyVelocity motion(std::uint32_t body, const BodySet& set, double h) const {
        return mean_velocity(set.bodies[body], end(body), h);
    }

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [placed, ends, index] = self;
        archive.scratch(placed, ends, index);
    }

private:
    std::vector<std::uint32_t> placed_;
    std::vector<RigidState> ends_;      // of these
    std::vector<std::uint32_t> index_;  // by body: in placed_
};

}  // namespace tumble
