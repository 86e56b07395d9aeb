// How an island bears its load: how much its bodies carry against what they weigh, and how high it is piled. Where either is
// much, sweeps converge slowly, whether it is a stack of many or one heavy body on a light one.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct LoadEstimate {
    /// The largest ratio, over the island's bodies, of the mass a body carries (its own included) to its own mass. From
    /// the bodies that touch something fixed outwards, each hands down what it carries in equal shares to its neighbours
    /// one level nearer.
    double ratio = 1.0;
    int levels = 1;   // bodies between the farthest one and what is fixed, itself included
};

class LoadEstimates {
public:
    explicit LoadEstimates(std::size_t bodies) : nodes_(bodies) {}

    LoadEstimate find(const std::vector<Body>& bodies, const std::vector<Manifold>& manifolds, std::span<const std::uint32_t> island_bodies,
                std::span<const std::uint32_t> island_manifolds);

private:
    struct Node {
        int level = -1, neighbours = 0;
        std::uint32_t first = 0;   // in neighbours_
        double load = 0.0;         // kg
    };
    std::vector<Node> nodes_;      // by body; only the island's are valid
    std::vector<std::uint32_t> neighbours_, order_;
};

}  // namespace tumble
