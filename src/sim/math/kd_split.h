// Bodies in halves of neighbours: cut at the median along a side of their box, and so on (k-d tree, Bentley 1975). Which half one is
// in depends on the bodies alone: of equal places the lower number comes first.
#pragma once

#include "core/vector.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tumble {

struct PlacedBody {
    Vec3 position;   // m
    std::uint32_t body;

    static auto before(int axis) {
        return [axis](const PlacedBody& l, const PlacedBody& r) {
            return l.position[axis] != r.position[axis] ? l.position[axis] < r.position[axis] : l.body < r.body;
        };
    }
};

/// The axis along which they are spread most, `skipped` left out.
inline int longest_side(std::span<const PlacedBody> items, int skipped = -1) {
    Bounds box;
    for (const PlacedBody& item : items) box.add(item.position);
    Vec3 extent = box.extent();
    if (skipped >= 0) extent[skipped] = -1.0;
    int axis = 0;
    extent.maxCoeff(&axis);
    return axis;
}

/// Brings the lower half to the front, and tells how many that are.
inline std::size_t cut_at_median(std::span<PlacedBody> items, int axis) {
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(half), items.end(), PlacedBody::before(axis));
    return half;
}

}  // namespace tumble
