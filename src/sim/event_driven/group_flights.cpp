#include "sim/event_driven/group_flights.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/joints/settings.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr int flight_order = 8;

}  // namespace

void GroupFlights::update(JointSet& joints, std::vector<Body>& bodies) {
    joints_ = &joints;
    bodies_ = &bodies;
    if (joints.changes() == changes_) return;
    changes_ = joints.changes();
    find();
}

void GroupFlights::find() {
    std::vector<JointGroup> groups = find_joint_groups(*joints_, *bodies_);
    std::vector<Flight> flights(groups.size());
    for (std::size_t g = 0, old = 0; g < groups.size(); ++g) {
        while (old < groups_.size() && groups_[old].bodies[0] < groups[g].bodies[0]) ++old;
        if (old < groups_.size() && groups_[old].bodies == groups[g].bodies && groups_[old].joints == groups[g].joints)
            flights[g] = std::move(flights_[old]);
    }
    groups_ = std::move(groups);
    flights_ = std::move(flights);
    group_of_.assign(groups_.empty() ? 0 : bodies_->size(), none);
    place_.assign(group_of_.size(), 0);
    active_.assign(groups_.size(), {});
    const JointSet& joints = *joints_;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
        for (std::uint32_t i = 0; i < groups_[g].bodies.size(); ++i) {
            group_of_[groups_[g].bodies[i]] = g;
            place_[groups_[g].bodies[i]] = i;
        }
        for (const std::uint32_t k : groups_[g].joints) {
            const auto at = std::lower_bound(joints.active().begin(), joints.active().end(), k);
            active_[g].push_back(std::uint32_t(at - joints.active().begin()));
        }
    }
}

bool GroupFlights::can_fly(std::uint32_t group, const ForceField& forces, double span) {
    for (const std::uint32_t k : groups_[group].bodies)
        if (!forces.only_gravity(k) || (*bodies_)[k].asleep) return false;
    const ContactProblem problem{*bodies_, no_manifolds_, no_velocities_, {span, infinity, 0.0}, nullptr, joints_};
    return JointFlight::flies({problem, groups_[group].bodies, active_[group], 1.0, 0.0, span});
}

void GroupFlights::remember(std::uint32_t group) {
    Flight& flight = flights_[group];
    flight.first.clear();
    flight.memory.clear();
    for (const std::uint32_t k : groups_[group].bodies) flight.first.push_back(state_of((*bodies_)[k]));
    for (const std::uint32_t k : groups_[group].joints) {
        const Joint& j = joints_->joints()[k];
        flight.memory.push_back({j.value, j.curving, j.constraint_force, j.constraint_rates, j.impulse, j.point});
    }
}

void GroupFlights::restore(std::uint32_t group) {
    const Flight& flight = flights_[group];
    for (std::size_t i = 0; i < flight.first.size(); ++i)
        set_state((*bodies_)[groups_[group].bodies[i]], flight.first[i]);
    for (std::size_t i = 0; i < flight.memory.size(); ++i) {
        Joint& j = joints_->joints()[groups_[group].joints[i]];
        const JointMemory& m = flight.memory[i];
        j.value = m.value;
        j.curving = m.curving;
        j.constraint_force = m.constraint_force;
        j.constraint_rates = m.constraint_rates;
        j.impulse = m.impulse;
        j.point = m.point;
        j.broken = false;
    }
}

// From the start of the flight; leaves the bodies there.
bool GroupFlights::fly(std::uint32_t group, double time) {
    Flight& flight = flights_[group];
    const JointGroup& members = groups_[group];
    if (time > 0.0) {
        std::vector<Body>& bodies = *bodies_;
        double length = 0.0;
        std::vector<StepForce> forces;
        for (const std::uint32_t k : members.bodies) {
            length += bodies[k].radius / double(members.bodies.size());
            forces.push_back({time * bodies[k].mass * flight.gravity, Vec3::Zero()});
        }
        const ContactProblem problem{bodies, no_manifolds_, no_velocities_, {time, infinity, 0.0}, nullptr, joints_};
        const JointIsland island{problem, members.bodies, active_[group], length, 0.0, time};
        for (;; flight.substeps *= 2) {
            restore(group);
            if (flight_.advance(island, forces, flight_order, flight.substeps)) break;
            if (!(flight_.swing() > tuning::joint_swing) || 2 * flight.substeps > tuning::joint_swing_substeps)
                return false;
        }
        for (const std::uint32_t k : members.joints)
            if (joints_->joints()[k].broken) return false;
    } else {
        restore(group);
    }
    flight.reached = time;
    flight.accounts.clear();
    for (const std::uint32_t k : members.joints) {
        Joint& joint = joints_->joints()[k];
        flight.accounts.push_back(time > 0.0 ? joint.account.step : JointAccount::Span{});
        joint.account.step = {};
        joint.force.setZero();
        joint.torque.setZero();
    }
    flight.there.clear();
    for (const std::uint32_t k : members.bodies) flight.there.push_back(state_of((*bodies_)[k]));
    return true;
}

bool GroupFlights::start(std::uint32_t group, const EventTime& now, double span, const Vec3& gravity) {
    Flight& flight = flights_[group];
    remember(group);
    flight.start = now;
    flight.span = span;
    flight.gravity = gravity;
    std::vector<Joint>& joints = joints_->joints();
    flight.substeps = 1;
    for (const std::uint32_t k : groups_[group].joints) flight.substeps = std::max(flight.substeps, joints[k].substeps);
    flight.flies = fly(group, span);
    flight.last = flight.there;
    const bool easy = flight_.swing() < tuning::joint_easy_swing;
    for (const std::uint32_t k : groups_[group].joints) {
        joints[k].substeps = easy ? std::max(1, flight.substeps / 2) : flight.substeps;
        joints[k].account.step = {};
    }
    if (!flight.flies) restore(group);
    return flight.flies;
}

// Leaves the bodies as they are.
RigidState GroupFlights::at(std::uint32_t body, double time) {
    const std::uint32_t g = group_of_[body];
    Flight& flight = flights_[g];
    time = std::clamp(time, 0.0, flight.span);
    if (time != flight.reached) {
        const std::vector<std::uint32_t>& members = groups_[g].bodies;
        std::vector<RigidState> present;
        for (const std::uint32_t k : members) present.push_back(state_of((*bodies_)[k]));
        fly(g, time);
        for (std::size_t i = 0; i < present.size(); ++i) set_state((*bodies_)[members[i]], present[i]);
    }
    return flight.there[place_[body]];
}

Trajectory GroupFlights::path(std::uint32_t body, double time) {
    const RigidState state = at(body, time);
    Body& b = (*bodies_)[body];
    const RigidState present = state_of(b);
    set_state(b, state);
    const Trajectory path = Trajectory::uniform(b, b.velocity, b.angular_velocity);
    set_state(b, present);
    return path;
}

void GroupFlights::cancel(std::uint32_t group) {
    restore(group);
    flights_[group].flies = false;
}

void GroupFlights::end(std::uint32_t group, double time) {
    Flight& flight = flights_[group];
    if (!flight.flies) return;
    flight.flies = false;
    const JointGroup& members = groups_[group];
    std::vector<RigidState> present;
    for (const std::uint32_t k : members.bodies) present.push_back(state_of((*bodies_)[k]));
    time = std::clamp(time, 0.0, flight.span);
    if (time != flight.reached) fly(group, time);
    for (std::size_t i = 0; i < present.size(); ++i) set_state((*bodies_)[members.bodies[i]], present[i]);
    for (std::size_t i = 0; i < members.joints.size(); ++i)
        joints_->joints()[members.joints[i]].account.take_flight(flight.accounts[i]);
}

void GroupFlights::keep_loads(std::uint32_t group, std::vector<JointLoad>& loads) const {
    for (const std::uint32_t k : groups_[group].joints)
        loads.push_back({joints_->joints()[k].force, joints_->joints()[k].torque, Vec3::Zero()});
}

void GroupFlights::take_solve(std::uint32_t group, const std::vector<JointLoad>& loads, std::size_t& next) {
    for (const std::uint32_t k : groups_[group].joints) {
        Joint& joint = joints_->joints()[k];
        joint.account.take_flight(joint.account.step);
        joint.account.step = {};
        joint.force = loads[next].force;
        joint.torque = loads[next++].torque;
    }
}

void GroupFlights::end_all() {
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
        if (!flights_[g].flies) continue;
        end(g, flights_[g].span);
        for (const std::uint32_t k : groups_[g].bodies) set_state((*bodies_)[k], end_of(k));
    }
}

}  // namespace tumble
