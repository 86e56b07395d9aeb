// The free motion of an island of joined bodies in one step: each group flies as if it were alone, in joint coordinates
// (tree_flight.h). Where other bodies are within reach, the flight is a trial in parts: it stands if no
// pair meets on its way.
#pragma once

#include "sim/articulation/flight_paths.h"
#include "sim/articulation/tree_flight.h"
#include "sim/dynamics/integrators/rigid_state.h"
#include "sim/joints/joint_set.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// A step of joined bodies from the present states, before its forces.
struct FlightStep {
    std::vector<Body>& bodies;
    JointSet& joints;
    std::vector<Manifold>& manifolds;
    const ForceField& forces;
    std::span<const std::uint32_t> island;  // bodies, ascending
    std::span<const std::uint32_t> held;    // indices into JointSet::active()
    std::span<const std::uint32_t> near;    // manifolds within reach
    double from, to;                        // s
};

class IslandFlight {
public:
    /// Finds the states at the end of the step, and the forces and accounts of the joints. The bodies stay as they are.
    /// Returns false, with the joints as they were, where the bodies do not fly, or meet.
    bool fly(const FlightStep& step);

    /// By body of the island.
    std::span<const RigidState> ends() const { return ends_; }

private:
    struct Group {
        std::vector<std::uint32_t> bodies, held;  // as of a step
        std::vector<std::size_t> places;          // of the bodies, in the island
        std::vector<Joint*> joints;

        double length(const FlightStep& step) const;  // m, mean radius
    };
    void find_groups(const FlightStep& step);
    bool fly(const FlightStep& step, const Group& group, int parts);
    TreeFlight::Outcome fly_part(const FlightStep& step, const Group& group, double from, double to, int& substeps);
    void set_substeps(const Group& group, int substeps) const;

    std::vector<Group> groups_;
    std::vector<std::uint32_t> found_for_, found_held_;  // of the groups: bodies and joints
    std::vector<RigidState> starts_, ends_;
    std::vector<std::array<double, Joint::coordinates>> values_;  // by joint, at the start
    TreeFlight tree_;
    FlightPaths paths_;
};

}  // namespace tumble
