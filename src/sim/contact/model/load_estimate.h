// Load estimate of an island: the mass that its bodies carry relative to their own, and the height of its pile. Where
// either is large, sweeps converge slowly, for a stack of many bodies as for one heavy body on a light one.
#pragma once

#include "sim/dynamics/body.h"
#include "sim/geometry/manifold.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct LoadEstimate {
    /// The largest ratio, over the island's bodies, of the mass that a body carries (its own included) to its own mass.
    /// Starting with the bodies farthest from a fixed support, each body distributes its carried mass in equal shares
    /// to its neighbors one level nearer.
    double ratio = 1.0;
    int levels = 1;  // number of bodies in the longest of the shortest chains to a fixed support, which does not count
    template <class Archive, class Self>
    static void visit(Archive& archive, Self& self) {
        auto& [ratio, levels] = self;
        archive.keep(ratio);
        archive.any(levels);
    }
};

class LoadEstimates {
public:
    explicit LoadEstimates(std::size_t bodies) : nodes_(bodies) {}

    LoadEstimate find(const std::vector<Body>& bodies, const std::vector<Manifold>& manifolds,
                      std::span<const std::uint32_t> island_bodies, std::span<const std::uint32_t> island_manifolds);

private:
    struct Node {
        int level = -1, neighbors = 0;
        std::uint32_t first = 0;  // index of the first neighbor
        double load = 0.0;        // kg
    };
    std::vector<Node> nodes_;  // by body; valid for the island's bodies
    std::vector<std::uint32_t> neighbors_, order_;
};

}  // namespace tumble
