#include "sim/memory_order.h"

#include "sim/tuning.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace tumble {
namespace {

struct Cutter {
    const std::vector<Body>& bodies;
    int upward;   // the axis nearest to gravity's, -1 without gravity

    void sort_along(std::span<std::uint32_t> items, int axis, std::size_t half) const {
        const auto before = [&](std::uint32_t l, std::uint32_t r) {
            const double x = bodies[l].position[axis], y = bodies[r].position[axis];
            return x != y ? x < y : l < r;
        };
        if (half == items.size()) std::sort(items.begin(), items.end(), before);
        else std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(half), items.end(), before);
    }

    void cut(std::span<std::uint32_t> items) const {
        Bounds box;
        for (const std::uint32_t i : items) box.add(bodies[i].position);
        Vec3 extent = box.extent();
        int axis = upward;
        if (items.size() <= tuning::ordered_column) {
            if (upward < 0) extent.maxCoeff(&axis);
            return sort_along(items, axis, items.size());
        }
        if (upward >= 0) extent[upward] = -1.0;
        extent.maxCoeff(&axis);
        const std::size_t half = items.size() / 2;
        sort_along(items, axis, half);
        cut(items.first(half));
        cut(items.subspan(half));
    }
};

}  // namespace

std::vector<std::uint32_t> put_in_memory_order(std::vector<Body>& bodies, const Vec3& gravity) {
    std::vector<std::uint32_t> order(bodies.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto movers = std::stable_partition(order.begin(), order.end(), [&](std::uint32_t i) { return !bodies[i].dynamic(); });
    if (std::size_t(order.end() - movers) < tuning::ordered_bodies) {
        std::iota(order.begin(), order.end(), 0u);
        return order;
    }
    int upward = -1;
    if (!gravity.isZero(0.0)) gravity.cwiseAbs().maxCoeff(&upward);
    Cutter{bodies, upward}.cut(std::span(movers, order.end()));
    std::vector<Body> ordered;
    ordered.reserve(bodies.size());
    for (const std::uint32_t i : order) ordered.push_back(std::move(bodies[i]));
    bodies = std::move(ordered);
    return order;
}

}  // namespace tumble
