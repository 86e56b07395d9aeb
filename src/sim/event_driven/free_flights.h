// integrator = "exact" with stepped impacts: a body that nothing touched since it took off is on its closed-form path,
// evaluated from the flight's beginning at every step, so that rounding does not add up from step to step.
#pragma once

#include "sim/event_driven/event_time.h"
#include "sim/ccd/trajectory.h"
#include "sim/dynamics/forces.h"

#include <memory>
#include <vector>

namespace tumble {

class FreeFlights {
public:
    FreeFlights(std::size_t bodies, const Vec3& gravity, const StepClock& clock);

    /// Moves the body from its state at `step`, before that step's forces, through the share (0 to 1) of the step.
    void advance(std::size_t index, Body& body, const ForceField& forces, std::int64_t step, double share);

private:
    struct Flight {
        Trajectory path;
        std::int64_t start = -1, reached = -1;   // steps
        // As the flight left it: a body that is found otherwise was touched, and flies on from there.
        Vec3 position = Vec3::Zero(), momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
    };
    Vec3 gravity_;
    StepClock clock_;
    std::vector<std::unique_ptr<Flight>> flights_;   // of the bodies that ever moved so: one is .8 KB
};

}  // namespace tumble
