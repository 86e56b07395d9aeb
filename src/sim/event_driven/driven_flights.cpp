#include "sim/event_driven/driven_flights.h"

#include "core/sort_unique.h"
#include "sim/dynamics/integrators/advance.h"

#include <algorithm>

namespace tumble {

Trajectory trajectory_between(Body& body, const RigidState& first, const RigidState& last, double span) {
    const RigidState present = state_of(body);
    set_state(body, last);
    const Motion end{last.position, body.velocity, last.orientation, body.rotation, body.angular_velocity};
    set_state(body, first);
    const Trajectory path = !(span > 0.0) ? Trajectory::uniform(body, body.velocity, body.angular_velocity)
                            : first.angular_momentum == last.angular_momentum ? Trajectory::towards(body, end, span)
                                                                              : Trajectory::between(body, end, span);
    set_state(body, present);
    return path;
}

void DrivenFlights::begin_step(std::vector<Body>& bodies, const ForceField& forces) {
    bodies_ = &bodies;
    forces_ = &forces;
    without_points_.clear();
    rest_.reset();
}

void DrivenFlights::forgo_points(std::uint32_t body) {
    if (!forces_->has_points(body) || std::binary_search(without_points_.begin(), without_points_.end(), body)) return;
    without_points_.push_back(body);
    sort_unique(without_points_);
    rest_ = forces_->without_points(without_points_);
}

void DrivenFlights::start(std::uint32_t body, double from) {
    flights_.resize(bodies_->size());
    flights_[body] = {state_of((*bodies_)[body]), from};
}

void DrivenFlights::start_pairs(std::span<const std::uint32_t> flying, double from) {
    std::vector<PairFlight::Member> members;
    for (const std::uint32_t i : forces_->pairs().bodies()) {
        const Body& body = (*bodies_)[i];
        members.push_back({std::binary_search(flying.begin(), flying.end(), i),
                           IntegratorKind::exact,
                           state_of(body),
                           {body.velocity, body.angular_velocity}});
    }
    pairs_.start(*bodies_, std::move(members), forces(), from);
}

RigidState DrivenFlights::at(std::uint32_t body, double time) {
    const auto index = forces_->pairs().bodies();
    if (const auto found = std::ranges::lower_bound(index, body); found != index.end() && *found == body)
        return pairs_.at(time)[std::size_t(found - index.begin())];
    const Flight& flight = flights_[body];
    return advance_exactly((*bodies_)[body], flight.start, forces(), body, flight.from, time);
}

Trajectory DrivenFlights::path(std::uint32_t body, double from, double to) {
    return trajectory_between((*bodies_)[body], at(body, from), at(body, to), to - from);
}

}  // namespace tumble
