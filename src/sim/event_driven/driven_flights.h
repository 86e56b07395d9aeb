// Flights of a step under forces that have no closed form: the states of each body at all times of its flight, as exact
// as double precision allows. Bodies with forces between each other fly together.
#pragma once

#include "sim/ccd/trajectory.h"
#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrators/pair_flight.h"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// A trajectory of `span` s through both states: cubic in position, with free rotation where the angular momentum is
/// the same and of third order otherwise. Changes the body for a moment only.
Trajectory trajectory_between(Body& body, const RigidState& first, const RigidState& last, double span);

class DrivenFlights {
public:
    /// Both must outlive the step.
    void begin_step(std::vector<Body>& bodies, const ForceField& forces);
    /// The forces at points of this step have acted on the body already, up to the step's end.
    void forgo_points(std::uint32_t body);
    const ForceField& forces() const { return rest_ ? *rest_ : *forces_; }

    /// A body flies from its present state at a time, s.
    void start(std::uint32_t body, double from);
    /// Bodies with forces between each other: the `flying` ones (ascending) fly, and the others move uniformly.
    void start_pairs(std::span<const std::uint32_t> flying, double from);
    /// The state of a body at a time from its start on. Throws RunError for too many steps.
    RigidState at(std::uint32_t body, double time);
    Trajectory path(std::uint32_t body, double from, double to);

private:
    struct Flight {
        RigidState start;
        double from = 0.0;
    };

    std::vector<Body>* bodies_ = nullptr;
    const ForceField* forces_ = nullptr;
    std::vector<std::uint32_t> without_points_;  // ascending
    std::optional<ForceField> rest_;             // without points of these bodies
    std::vector<Flight> flights_;                // by body; empty before the first flight
    PairFlight pairs_;
};

}  // namespace tumble
