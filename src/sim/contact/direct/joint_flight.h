// Flight of joined bodies that touch nothing and whose joints form loops, or are distance joints: RATTLE, to second order, and its symmetric compositions of order 4, 6, 8.
//
// With half a kick by the forces, the joints' impulses J^T f close all gaps at the end of a free drift; after the second
// half kick, J^T g makes the velocities fit the joints (Andersen 1983, J. Comput. Phys. 52; symplectic: Leimkuhler and
// Skeel 1994, J. Comput. Phys. 112; rigid bodies with a split drift: Kol, Laird, Leimkuhler 1997, J. Chem. Phys. 107).
// Each stage ends with closed joints and fitting velocities, so compositions of stages have no drift either (Hairer,
// Lubich, Wanner, Geometric Numerical Integration, section V.3).
#pragma once

#include "sim/contact/direct/flight_locks.h"
#include "sim/math/block_cholesky.h"

#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// Impulse (N s) and angular impulse (N m s) of a body's forces over the step: they act evenly.
struct StepForce {
    Vec3 push, turn;
};

class JointFlight {
public:
    /// Whether the island's motion is free but for its locked joints and gravity-like forces: no dampers, motors or
    /// friction, no limit within reach, and no moving carrier.
    static bool flies(const JointIsland& island);
    static int order(const JointIsland& island);

    /// Moves the island's bodies over the step from their present state, the start of the step without its forces.
    /// Returns false, and leaves the bodies in any state, where the passes do not converge, a limit is met or a joint
    /// breaks.
    bool advance(const JointIsland& island, std::span<const StepForce> forces, int order, int substeps);
    /// Moves the bodies by the least displacements, in the metric of their masses, that close the locked coordinates at
    /// the present poses. Momenta stay, and so does the center of mass of a free island. Joints that are wide open, as
    /// those that are pulled in, stay as they are.
    void close_poses(const JointIsland& island);
    /// Largest phase (rad) of a link's swing in a substep of the last advance().
    double swing() const { return swing_; }

private:
    struct Stage {
        std::span<const StepForce> forces;
        double share = 1.0;  // of the step
        double h = 0.0;      // s; negative in some stages of the compositions
    };
    using Rate = ConstraintRate ConstraintRates::*;
    void analyze(const JointIsland& island);
    bool load(double h);
    double look(double h, std::optional<Rate> rate);
    bool start(double h, Rate rate);
    void estimate(const FlightLocks::FlightJoint& j, double h, Rate rate);
    void finish(const Stage& stage, Rate rate);
    bool fly(const Stage& stage);
    bool close(double h);
    bool fit();
    bool change();
    void kick(const Stage& stage, bool moved);
    void drift(FlightBody& body, double h) const;
    double find_swing(double bound, double h);
    void add_up(FlightLocks::FlightJoint& j, const JointLoad& load);
    static bool flies_with_springs(const JointIsland& island, const Joint& joint);
    void kick_springs(double time);  // s
    void count_turns();
    bool end(const JointIsland& island);

    FlightLocks locks_;
    BlockCholesky matrix_;
    std::vector<BlockCholesky::Pair> pairs_;
    std::vector<double> change_;  // du: six numbers per body
    bool springs_ = false;        // a joint has springs
    bool loaded_ = false;         // locks and equations are those of the present poses
    double coarse_ = 1.0;         // factor of the tolerances
    double closed_ = 0.0;         // largest error of closed joints, in sizes of the joint
    double swing_ = 0.0, compliance_ = 0.0;
};

}  // namespace tumble
