#include "sim/event_driven/group_flights.h"

#include "sim/contact/model/contact_constraint.h"
#include "sim/event_driven/driven_flights.h"
#include "sim/joints/joint_way.h"
#include "sim/joints/settings.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr int flight_order = 8;

}  // namespace

void GroupFlights::update(JointSet& joints, std::vector<Body>& bodies, const ForceField& forces) {
    joints_ = &joints;
    bodies_ = &bodies;
    forces_ = &forces;
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

bool GroupFlights::can_fly(std::uint32_t group, const ForceField& forces) {
    for (const std::uint32_t k : groups_[group].bodies)
        if (!forces.only_gravity(k) || (*bodies_)[k].gravity_scale != 1.0 || (*bodies_)[k].asleep) return false;
    const std::vector<Joint*> joints = joints_of(group);
    return std::none_of(joints.begin(), joints.end(),
                        [&](const Joint* joint) { return on_moving_carrier(*joint, *bodies_); }) &&
           tree_laws(joints, *bodies_);
}

std::vector<GroupFlights::JointMemory> GroupFlights::memory_of(std::uint32_t group) const {
    std::vector<JointMemory> memory;
    for (const std::uint32_t k : groups_[group].joints) {
        const Joint& j = joints_->joints()[k];
        memory.push_back({j.value, j.curving, j.impulse, j.point});
    }
    return memory;
}

void GroupFlights::remember(std::uint32_t group) {
    Flight& flight = flights_[group];
    flight.first.clear();
    for (const std::uint32_t k : groups_[group].bodies) flight.first.push_back(state_of((*bodies_)[k]));
    flight.memory = memory_of(group);
}

void GroupFlights::set_joints(std::uint32_t group, const std::vector<JointMemory>& memory) {
    for (std::size_t i = 0; i < memory.size(); ++i) {
        Joint& j = joints_->joints()[groups_[group].joints[i]];
        const JointMemory& m = memory[i];
        j.value = m.value;
        j.curving = m.curving;
        j.impulse = m.impulse;
        j.point = m.point;
    }
}

void GroupFlights::restore(std::uint32_t group) {
    const Flight& flight = flights_[group];
    for (std::size_t i = 0; i < flight.first.size(); ++i)
        set_state((*bodies_)[groups_[group].bodies[i]], flight.first[i]);
    set_joints(group, flight.memory);
    for (const std::uint32_t k : groups_[group].joints) joints_->joints()[k].broken = false;
}

std::vector<Joint*> GroupFlights::joints_of(std::uint32_t group) const {
    std::vector<Joint*> joints;
    for (const std::uint32_t k : groups_[group].joints) joints.push_back(&joints_->joints()[k]);
    return joints;
}

// Gravity does not depend on time: flights begin at 0.
TreeFlight::Outcome GroupFlights::fly_tree(std::uint32_t group, const JointIsland& island) {
    const std::vector<Joint*> joints = joints_of(group);
    if (!tree_laws(joints, *bodies_)) return TreeFlight::Outcome::declined;
    Flight& flight = flights_[group];
    TreeStep step{*bodies_, island.bodies, joints, *forces_, 0.0, island.to, island.length, flight.span};
    step.all = island.problem.joints->joints();
    TreeFlight::Outcome outcome = tree_flight_.advance(step, {IntegratorKind::exact, flight_order}, flight.substeps);
    if (outcome != TreeFlight::Outcome::declined || !tree_flight_.is_tree()) return outcome;
    outcome = tree_flight_.advance(step, {IntegratorKind::splitting, flight_order}, flight.substeps);
    flight.phase = tree_flight_.phase();
    return outcome == TreeFlight::Outcome::flown ? outcome : TreeFlight::Outcome::stopped;
}

// From the start of the flight; leaves the bodies there.
bool GroupFlights::fly(std::uint32_t group, double time) {
    Flight& flight = flights_[group];
    const JointGroup& members = groups_[group];
    restore(group);
    if (time > 0.0) {
        double length = 0.0;
        for (const std::uint32_t k : members.bodies) length += (*bodies_)[k].radius / double(members.bodies.size());
        const ContactProblem problem{*bodies_, no_manifolds_, no_velocities_, {time, infinity, 0.0}, nullptr, joints_};
        const JointIsland island{problem, members.bodies, active_[group], length, 0.0, time};
        if (fly_tree(group, island) != TreeFlight::Outcome::flown) return false;
        for (const std::uint32_t k : members.joints)
            if (joints_->joints()[k].broken) return false;
    }
    Reached& reached = flight.reached.emplace_back();
    reached.time = time;
    reached.memory = memory_of(group);
    for (const std::uint32_t k : members.joints) {
        Joint& joint = joints_->joints()[k];
        reached.accounts.push_back(time > 0.0 ? joint.account.step : JointAccount::Span{});
        joint.account.step = {};
        joint.force.setZero();
        joint.torque.setZero();
    }
    for (const std::uint32_t k : members.bodies) reached.states.push_back(state_of((*bodies_)[k]));
    return true;
}

bool GroupFlights::start(std::uint32_t group, double span) {
    Flight& flight = flights_[group];
    remember(group);
    flight.span = span;
    std::vector<Joint>& joints = joints_->joints();
    flight.substeps = 1;
    for (const std::uint32_t k : groups_[group].joints) flight.substeps = std::max(flight.substeps, joints[k].substeps);
    flight.phase = tuning::joint_easy_phase;
    flight.reached.clear();
    flight.flies = fly(group, span);
    const bool easy = flight.phase < tuning::joint_easy_phase;
    for (const std::uint32_t k : groups_[group].joints) {
        joints[k].substeps = easy ? std::max(1, flight.substeps / 2) : flight.substeps;
        joints[k].account.step = {};
    }
    if (!flight.flies) restore(group);
    return flight.flies;
}

// Leaves the bodies as they are. A flight that fails on the way, near a limit that it then leaves, stands for its end.
const GroupFlights::Reached& GroupFlights::reach(std::uint32_t group, double time) {
    Flight& flight = flights_[group];
    time = std::clamp(time, 0.0, flight.span);
    for (const Reached& reached : flight.reached)
        if (reached.time == time) return reached;
    const std::vector<std::uint32_t>& members = groups_[group].bodies;
    std::vector<RigidState> present;
    for (const std::uint32_t k : members) present.push_back(state_of((*bodies_)[k]));
    const bool flown = fly(group, time);
    for (std::size_t i = 0; i < present.size(); ++i) set_state((*bodies_)[members[i]], present[i]);
    return flown ? flight.reached.back() : flight.reached.front();
}

const RigidState& GroupFlights::at(std::uint32_t body, double time) {
    return reach(group_of_[body], time).states[place_[body]];
}

Trajectory GroupFlights::path(std::uint32_t body, double from, double to) {
    const RigidState first = at(body, from), last = at(body, to);
    return trajectory_between((*bodies_)[body], first, last, to - from);
}

void GroupFlights::cancel(std::uint32_t group) {
    restore(group);
    flights_[group].flies = false;
}

void GroupFlights::end(std::uint32_t group, double time) {
    Flight& flight = flights_[group];
    if (!flight.flies) return;
    const Reached& reached = reach(group, time);
    flight.flies = false;
    set_joints(group, reached.memory);
    for (std::size_t i = 0; i < reached.accounts.size(); ++i)
        joints_->joints()[groups_[group].joints[i]].account.take_flight(reached.accounts[i]);
}

void GroupFlights::keep_loads(std::uint32_t group, std::vector<JointReaction>& loads) const {
    for (const std::uint32_t k : groups_[group].joints)
        loads.push_back({joints_->joints()[k].force, joints_->joints()[k].torque, Vec3::Zero()});
}

void GroupFlights::take_solve(std::uint32_t group, const std::vector<JointReaction>& loads, std::size_t& next) {
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
