#include "sim/detection/spatial_sort.h"

#include "sim/math/bounds_tree.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace tumble {
namespace {

/// Number of moving bodies from which on bodies are sorted by position in memory (spatial_sort.h), and number of
/// bodies in a vertical column. Limits the cost.
constexpr std::size_t ordered_bodies = 512;
constexpr std::size_t ordered_column = 32;

// `upward`: index of the axis nearest to gravity's, -1 without gravity.
void cut(std::span<PlacedBody> items, int upward) {
    if (items.size() <= ordered_column) {
        std::sort(items.begin(), items.end(), PlacedBody::before(upward >= 0 ? upward : longest_side(items)));
        return;
    }
    const std::size_t half = cut_at_median(items, longest_side(items, upward));
    cut(items.first(half), upward);
    cut(items.subspan(half), upward);
}

// Moves body order[k] to k, cycle by cycle: a million bodies have no room for a second list.
void put_in_place(std::vector<Body>& bodies, const std::vector<std::uint32_t>& order) {
    std::vector<bool> placed(bodies.size());
    for (std::uint32_t start = 0; start < bodies.size(); ++start) {
        if (placed[start]) continue;
        Body first = std::move(bodies[start]);
        std::uint32_t to = start;
        for (; order[to] != start; to = order[to]) {
            bodies[to] = std::move(bodies[order[to]]);
            placed[to] = true;
        }
        bodies[to] = std::move(first);
        placed[to] = true;
    }
}

}  // namespace

std::vector<std::uint32_t> put_in_memory_order(std::vector<Body>& bodies, const Vec3& gravity) {
    std::vector<std::uint32_t> order;
    std::vector<PlacedBody> movers;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i].dynamic())
            movers.push_back({bodies[i].position, i});
        else
            order.push_back(i);
    }
    if (movers.size() < ordered_bodies) {
        order.resize(bodies.size());
        std::iota(order.begin(), order.end(), 0u);
        return order;
    }
    int upward = -1;
    if (!gravity.isZero(0.0)) gravity.cwiseAbs().maxCoeff(&upward);
    cut(movers, upward);
    for (const PlacedBody& mover : movers) order.push_back(mover.body);
    put_in_place(bodies, order);
    return order;
}

}  // namespace tumble
