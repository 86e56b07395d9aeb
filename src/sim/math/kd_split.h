// Halves a set of bodies by place: cut at the median along a side of their bounding box, and recursively (k-d tree,
// Bentley 1975). The halves depend on the bodies alone: at equal places the lower index comes first.
#pragma once

#include "core/vector.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tumble {

struct PlacedBody {
    Vec3 position;  // m
    std::uint32_t body;

    static auto before(int axis) {
        return [axis](const PlacedBody& l, const PlacedBody& r) {
            return l.position[axis] != r.position[axis] ? l.position[axis] < r.position[axis] : l.body < r.body;
        };
    }
};

/// The axis of largest spread, except `skipped`.
inline int longest_side(std::span<const PlacedBody> items, int skipped = -1) {
    Bounds box;
    for (const PlacedBody& item : items) box.add(item.position);
    Vec3 extent = box.extent();
    if (skipped >= 0) extent[skipped] = -1.0;
    int axis = 0;
    extent.maxCoeff(&axis);
    return axis;
}

/// Moves the lower half to the front and returns its size.
inline std::size_t cut_at_median(std::span<PlacedBody> items, int axis) {
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(half), items.end(), PlacedBody::before(axis));
    return half;
}

}  // namespace tumble
