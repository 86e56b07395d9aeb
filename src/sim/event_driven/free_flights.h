// integrator = "exact" with stepped impacts: a body without contact is on its closed-form trajectory, evaluated from
// the start of the flight at every step, so that rounding does not accumulate from step to step.
#pragma once

#include "sim/ccd/trajectory.h"
#include "sim/dynamics/forces.h"
#include "sim/event_driven/event_time.h"

#include <memory>
#include <vector>

namespace tumble {

class FreeFlights {
public:
    FreeFlights(std::size_t bodies, const Vec3& gravity, const StepClock& clock);

    /// Moves the body from its state at `step`, before that step's forces, through the fraction `share` (0 to 1) of the
    /// step.
    void advance(std::size_t index, Body& body, const ForceField& forces, std::int64_t step, double share);

    /// For checkpoints: see sim/checkpoint/archive.h.
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [gravity, clock, flights] = self;
        archive.rebuilt(gravity, clock);
        archive.by_body(flights);
    }

private:
    struct Flight {
        Trajectory path;
        std::int64_t start = -1, reached = -1;  // steps
        // State at the end of the last advance: a body found in another state was touched, and starts a new flight.
        Vec3 position = Vec3::Zero(), momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
        template <class Archive, class Self>
        static void visit(Archive& archive, Self& self) {
            auto& [path, start, reached, position, momentum, angular_momentum] = self;
            archive.between(-1, start, EventTime::last_step);
            archive.between(-1, reached, EventTime::last_step);
            archive.keep(path, position, momentum, angular_momentum);
        }
    };
    Vec3 gravity_;
    StepClock clock_;
    std::vector<std::unique_ptr<Flight>> flights_;  // of the bodies that ever moved so: each takes 0.8 KB
};

}  // namespace tumble
