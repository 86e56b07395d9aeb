// Forces of [[pair_force]] tables between the centers of mass of bodies.
#pragma once

#include "scene/description/force_fields.h"
#include "sim/fields/position_forces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class PairForces {
public:
    /// `place`: index of each body of the scene in the simulation.
    PairForces(const std::vector<PairForceDescription>& forces, std::span<const std::size_t> place);

    bool empty() const { return forces_.empty(); }
    /// The bodies with such forces, ascending. All spans below are in their order.
    std::span<const std::uint32_t> bodies() const { return bodies_; }
    bool has(std::uint32_t body) const;

    /// Adds the forces at a time, N; and the means over [from, to) for bodies that stay where they are.
    void add(std::span<const MassPoint> points, double time, std::span<Vec3> forces) const;
    void add_mean(std::span<const MassPoint> points, double from, double to, std::span<Vec3> forces) const;
    /// Fastest rate at which a pair changes its motion, 1/s. A body without a mass does not move.
    double rate(std::span<const MassPoint> points, double time) const;
    double next_change(double time) const;

    /// J, of the forces that act at all times.
    double potential(std::span<const MassPoint> points) const;

private:
    template <class Use>
    void each_pair(const PairForceDescription& force, std::span<const MassPoint> points, const Use& use) const;

    std::vector<std::uint32_t> bodies_;
    std::vector<PairForceDescription> forces_;  // with indices into bodies_
};

}  // namespace tumble
