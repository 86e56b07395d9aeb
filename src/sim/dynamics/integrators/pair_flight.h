// A step without contact of bodies with forces between each other: all of them from their whole states, by the finest
// of their integrators.
#pragma once

#include "sim/dynamics/forces.h"
#include "sim/dynamics/integrators/rigid_state.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace tumble {

class PairFlight {
public:
    /// Bodies of the forces, in the order of PairForces::bodies(): in flight, or moved by others.
    struct Member {
        bool flies = false;
        IntegratorKind integrator = IntegratorKind::exact;
        RigidState start;       // of one that is moved by others, its pose
        BodyVelocity velocity;  // constant, of one that is moved by others
    };

    /// All members start at `from` (s). The bodies and forces must outlive the flight.
    void start(const std::vector<Body>& bodies, std::vector<Member> members, const ForceField& forces, double from);
    /// The states of the members that fly, at a time from the start on. Throws RunError for too many steps.
    const std::vector<RigidState>& at(double time);

private:
    struct Span {
        double from, to, middle;  // s
    };
    void advance(double to);
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
    std::vector<Member> members_;
    std::vector<std::pair<double, std::vector<RigidState>>> reached_;  // by time
    double start_ = 0.0, middle_ = 0.0, span_start_ = 0.0;             // s
    std::vector<RigidState> states_;
    std::vector<RigidMass> masses_;
    std::vector<MassPoint> points_;
    std::vector<PairTurn> turns_of_;  // where dipoles act
    std::vector<Wrench> pulls_;
    std::vector<std::size_t> flying_;
    bool turns_ = false, exactly_ = false, by_parts_ = true;
};

}  // namespace tumble
