// A step without contact of bodies with forces between each other: all of them from their whole states, by the finest
// of their integrators.
#pragma once

#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrators/rigid_state.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class PairFlight {
public:
    /// Bodies of the forces, in the order of PairForces::bodies(): in flight, from this state; or moved by others.
    struct Member {
        bool flies = false;
        RigidState start;
    };

    /// Finds the states at `to` (s) from those at `from`. The bodies that do not fly move at their present velocities.
    /// Throws RunError for too many steps.
    void advance(const std::vector<Body>& bodies, std::span<const Member> members, const ForceField& forces,
                 double from, double to);
    /// The state of a member that flies.
    const RigidState& end(std::size_t member) const { return states_[member]; }
    /// A member ends elsewhere.
    void stop(std::size_t member, const RigidState& end) { states_[member] = end; }

private:
    struct Span {
        double from, to, middle;  // s
    };
    void place_others(double time);
    void gather();
    PairBodies present() const { return {points_, turns_of_}; }
    void kick(double h, double time);
    void split(const Span& span);
    void step(const Span& span, bool exact);
    void exact(const Span& span);
    double rate() const;
    Eigen::VectorXd rates(const Eigen::VectorXd& y);

    const std::vector<Body>* bodies_ = nullptr;
    const ForceField* forces_ = nullptr;
    std::span<const Member> members_;
    double start_ = 0.0, middle_ = 0.0, span_start_ = 0.0;  // s
    std::vector<RigidState> states_;
    std::vector<RigidMass> masses_;
    std::vector<MassPoint> points_;
    std::vector<PairTurn> turns_of_;  // where dipoles act
    std::vector<Wrench> pulls_;
    std::vector<std::size_t> flying_;
    bool turns_ = false;
};

}  // namespace tumble
