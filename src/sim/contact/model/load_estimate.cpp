#include "sim/contact/model/load_estimate.h"

#include <algorithm>

namespace tumble {

LoadEstimate LoadEstimates::find(const std::vector<Body>& bodies, const std::vector<Manifold>& manifolds,
                                 std::span<const std::uint32_t> island_bodies,
                                 std::span<const std::uint32_t> island_manifolds) {
    for (const std::uint32_t i : island_bodies) nodes_[i] = {-1, 0, 0, bodies[i].mass};
    const auto both = [&](const Manifold& m) { return bodies[m.a].dynamic() && bodies[m.b].dynamic(); };
    order_.clear();
    for (const std::uint32_t k : island_manifolds) {
        const Manifold& m = manifolds[k];
        if (both(m)) {
            ++nodes_[m.a].neighbors;
            ++nodes_[m.b].neighbors;
            continue;
        }
        const std::uint32_t i = bodies[m.a].dynamic() ? m.a : m.b;
        if (nodes_[i].level == 0) continue;
        nodes_[i].level = 0;
        order_.push_back(i);
    }
    std::uint32_t next = 0;
    for (const std::uint32_t i : island_bodies) {
        nodes_[i].first = next;
        next += std::uint32_t(nodes_[i].neighbors);
        nodes_[i].neighbors = 0;
    }
    neighbors_.resize(next);
    for (const std::uint32_t k : island_manifolds) {
        const Manifold& m = manifolds[k];
        if (!both(m)) continue;
        neighbors_[nodes_[m.a].first + std::uint32_t(nodes_[m.a].neighbors++)] = m.b;
        neighbors_[nodes_[m.b].first + std::uint32_t(nodes_[m.b].neighbors++)] = m.a;
    }
    const auto each_neighbor = [&](std::uint32_t i, auto&& visit) {
        for (int n = 0; n < nodes_[i].neighbors; ++n)
            visit(nodes_[neighbors_[nodes_[i].first + std::uint32_t(n)]],
                  neighbors_[nodes_[i].first + std::uint32_t(n)]);
    };
    for (std::size_t k = 0; k < order_.size(); ++k) {
        const std::uint32_t i = order_[k];
        each_neighbor(i, [&](Node& node, std::uint32_t j) {
            if (node.level >= 0) return;
            node.level = nodes_[i].level + 1;
            order_.push_back(j);
        });
    }
    LoadEstimate pile;
    for (std::size_t k = order_.size(); k-- > 0;) {
        const Node& node = nodes_[order_[k]];
        pile.ratio = std::max(pile.ratio, node.load / bodies[order_[k]].mass);
        pile.levels = std::max(pile.levels, node.level + 1);
        int lower = 0;
        each_neighbor(order_[k], [&](Node& other, std::uint32_t) { lower += other.level < node.level; });
        each_neighbor(order_[k], [&](Node& other, std::uint32_t) {
            if (other.level < node.level) other.load += node.load / lower;
        });
    }
    return pile;
}

}  // namespace tumble
