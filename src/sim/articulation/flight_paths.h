// Paths of an island's bodies in a step in which its groups of joined bodies fly, in equal parts, and the search for
// pairs that meet on them.
#pragma once

#include "sim/ccd/trajectory.h"
#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class FlightPaths {
public:
    /// Paths of all bodies (indices, ascending) with their present velocities, in `parts` equal parts of a step of `h`
    /// s.
    void start(const std::vector<Body>& all, std::span<const std::uint32_t> bodies, int parts, double h);
    /// A body (index in start()) has flown through a part.
    void add(std::size_t body, int part, const Body& before, const Body& after);

    /// True if two bodies of a manifold meet. Bodies that start() was not given keep their velocities.
    bool any_meet(const std::vector<Body>& all, const std::vector<Manifold>& manifolds,
                  std::span<const std::uint32_t> of_island) const;

private:
    bool meet(const Body& a, const Trajectory& path_a, const Body& b, const Trajectory& path_b) const;

    std::span<const std::uint32_t> bodies_;
    int parts_ = 1;
    double span_ = 0.0;              // s, of a part
    std::vector<Trajectory> paths_;  // by body, then by part
};

}  // namespace tumble
