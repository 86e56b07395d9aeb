#include "sim/event_driven/free_flights.h"

#include "sim/dynamics/body.h"
#include "sim/dynamics/integrators/advance.h"

namespace tumble {

FreeFlights::FreeFlights(std::size_t bodies, const Vec3& gravity, const StepClock& clock)
    : gravity_(gravity), clock_(clock), flights_(bodies) {}

void FreeFlights::advance(std::size_t index, Body& body, const ForceField& forces, std::int64_t step, double share) {
    const double from = clock_.seconds(step), to = from + share * clock_.seconds(1);
    if (share < 1.0 || !forces.constant(index, from, to)) {
        set_state(body, advance_exactly(body, forces, index, from, to));
        return;
    }
    if (!flights_[index]) flights_[index] = std::make_unique<Flight>();
    Flight& flight = *flights_[index];
    const bool goes_on = flight.reached == step && flight.position == body.position &&
                         flight.momentum == body.momentum && flight.angular_momentum == body.angular_momentum;
    if (!goes_on) {
        body.derive();
        flight.path = Trajectory::flight(body, body.fall(gravity_));
        flight.start = step;
    }
    const double t = clock_.seconds(step + 1 - flight.start);
    const Motion motion = flight.path.at(t);
    body.position = motion.position;
    body.orientation = motion.orientation;
    body.rotation = motion.rotation;
    body.momentum = body.mass * motion.velocity;
    body.derive();
    flight.reached = step + 1;
    flight.position = body.position;
    flight.momentum = body.momentum;
    flight.angular_momentum = body.angular_momentum;
}

}  // namespace tumble
