// Flight of groups of joined bodies between events: in each step from its start, or from an impact, to its end.
//
// A group that touches nothing moves in joint coordinates (tree_flight.h). A trajectory through the states at both ends
// serves the search for impacts; the time of an impact is then refined by flying the group from its start to that time,
// so it has the accuracy of the flight.
#pragma once

#include "sim/articulation/tree_flight.h"
#include "sim/ccd/trajectory.h"
#include "sim/contact/direct/joint_rows.h"
#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/joints/joint_groups.h"

#include <cstdint>
#include <vector>

namespace tumble {

class GroupFlights {
public:
    static constexpr std::uint32_t none = UINT32_MAX;

    /// Finds the groups again where joints have begun or ended to hold. All are kept by reference.
    void update(JointSet& joints, std::vector<Body>& bodies, const ForceField& forces);
    /// Finds the groups again, as after a joint has broken. Flights of unchanged groups go on.
    void find();

    const std::vector<JointGroup>& groups() const { return groups_; }
    /// The group of a body; none for a free one.
    std::uint32_t group(std::uint32_t body) const { return body < group_of_.size() ? group_of_[body] : none; }
    JointSet& joints() const { return *joints_; }
    bool empty() const { return groups_.empty(); }

    /// True if the group's motion is free but for its joints and gravity.
    bool can_fly(std::uint32_t group, const ForceField& forces);
    /// Flies the group for `span` s from its present state, and leaves it there. Returns false where a joint comes to a
    /// limit, breaks or has no solution in that time.
    bool start(std::uint32_t group, double span);
    /// Moves a body of the group to its state `time` s after the start of the flight.
    void bring(std::uint32_t body, double time) { set_state((*bodies_)[body], at(body, time)); }
    /// Its path between two such times, through the states of the flight at both; leaves the bodies as they are.
    Trajectory path(std::uint32_t body, double from, double to);
    /// The flight has not begun: its joints and bodies are as before it.
    void cancel(std::uint32_t group);
    /// The flight ends `time` s after its start: adds its impulses to the joints' accounts, and leaves the bodies as
    /// they are.
    void end(std::uint32_t group, double time);
    /// The same at the end of its span, for all groups that fly: moves their bodies there.
    void end_all();
    /// Around a solve instead of a flight: keeps the loads of the joints, and adds the solve's impulses to their
    /// accounts.
    void keep_loads(std::uint32_t group, std::vector<JointReaction>& loads) const;
    void take_solve(std::uint32_t group, const std::vector<JointReaction>& loads, std::size_t& next);
    const RigidState& start_of(std::uint32_t body) const { return flights_[group_of_[body]].first[place_[body]]; }
    /// State of a body at the end of the flight.
    const RigidState& end_of(std::uint32_t body) const {
        return flights_[group_of_[body]].reached[0].states[place_[body]];
    }

private:
    /// The state of a joint that a flight changes.
    struct JointMemory {
        std::array<double, Joint::coordinates> value{}, curving{};
        std::array<std::array<double, Joint::laws>, Joint::coordinates> impulse{};
        Vec3 point;
    };
    struct Reached {
        double time = 0.0;                         // s since the start
        std::vector<RigidState> states;            // by body of the group
        std::vector<JointMemory> memory;           // by joint of the group
        std::vector<JointAccount::Span> accounts;  // by joint, since the start
    };
    struct Flight {
        double span = 0.0;                // s
        std::vector<RigidState> first;    // by body, at the start
        std::vector<JointMemory> memory;  // by joint, at the start
        std::vector<Reached> reached;     // at the end, and at all times asked for
        int substeps = 1;                 // of a flight by rows
        double phase = 0.0;               // rad, of its last one
        bool flies = false;
    };
    bool fly(std::uint32_t group, double time);
    TreeFlight::Outcome fly_tree(std::uint32_t group, const JointIsland& island);
    const Reached& reach(std::uint32_t group, double time);
    const RigidState& at(std::uint32_t body, double time);
    std::vector<Joint*> joints_of(std::uint32_t group) const;
    std::vector<JointMemory> memory_of(std::uint32_t group) const;
    void remember(std::uint32_t group);
    void restore(std::uint32_t group);
    void set_joints(std::uint32_t group, const std::vector<JointMemory>& memory);

    JointSet* joints_ = nullptr;
    std::vector<Body>* bodies_ = nullptr;
    const ForceField* forces_ = nullptr;
    std::uint64_t changes_ = 0;  // of the joint set, at the last update
    std::vector<JointGroup> groups_;
    std::vector<std::vector<std::uint32_t>> active_;  // by group: its joints in the set's list of active ones
    std::vector<std::uint32_t> group_of_, place_;     // by body; index in the group
    std::vector<Flight> flights_;                     // by group
    TreeFlight tree_flight_;
    std::vector<Manifold> no_manifolds_;
    std::vector<BodyVelocity> no_velocities_;
};

}  // namespace tumble
