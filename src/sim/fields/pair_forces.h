// Forces of [[pair_force]] tables between the centers of mass of bodies, and torques of dipoles.
#pragma once

#include "scene/description/force_fields.h"
#include "sim/fields/position_forces.h"
#include "sim/math/wrench.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The rotation of a body with a dipole.
struct PairTurn {
    Mat3 rotation = Mat3::Identity();  // body to world
    double inverse_inertia = 0.0;      // 1/(kg m^2), the largest; 0 of a body that no force moves
};

/// Bodies in the order of PairForces::bodies(); turns only where has_torques() is true. A body without mass is absent.
struct PairBodies {
    std::span<const MassPoint> points;
    std::span<const PairTurn> turns;
};

/// A body in pieces, which share its force by their masses and do not act on each other.
struct BodyInPieces {
    struct Piece {
        std::uint32_t body;
        double share;  // of the mass of the whole
    };
    std::uint32_t whole;
    std::vector<Piece> pieces;  // ascending
};

class PairForces {
public:
    /// `place`: index of each body of the scene in the simulation.
    PairForces(const std::vector<PairForceDescription>& forces, std::span<const std::size_t> place);
    /// All bodies that are in pieces now.
    void break_up(std::span<const BodyInPieces> broken);

    bool empty() const { return forces_.empty(); }
    /// The bodies with such forces, ascending. All spans below are in their order.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    bool has(std::uint32_t body) const;
    bool has_torques() const { return !magnets_.empty(); }
    /// True if a torque acts on the body at a time.
    bool turns(std::uint32_t body, double time) const;

    /// Adds the forces and torques at a time; and the means over [from, to) for bodies that stay where they are.
    void add(const PairBodies& bodies, double time, std::span<Wrench> wrenches) const;
    void add_mean(const PairBodies& bodies, double from, double to, std::span<Wrench> wrenches) const;
    /// Fastest rate at which a pair changes its motion, 1/s. A body without a mass does not move.
    double rate(const PairBodies& bodies, double time) const;
    double next_change(double time) const;

    /// J, of the forces that act at all times.
    double potential(const PairBodies& bodies) const;

private:
    struct Force : PairForceDescription {  // with indices into bodies_, and charges and moments of pieces
        std::vector<std::size_t> wholes;   // of the bodies, as given
        std::vector<double> shares;        // of the bodies in these
    };
    template <class Use>
    void each_pair(const Force& force, const PairBodies& bodies, const Use& use) const;

    std::vector<PairForceDescription> given_;  // with indices of the simulation
    std::vector<std::uint32_t> bodies_;
    std::vector<Force> forces_;
    std::vector<std::uint32_t> magnets_;  // bodies with dipoles, ascending
};

}  // namespace tumble
