// Bodies so far from the eye that they are small in the picture, lost ones among them, spoil nothing that is fitted to the rest.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace tumble {

/// The middle one of an odd number; of an even one the lower of both: one of two may be lost.
inline double lower_median(std::vector<double>& values) {
    const auto middle = values.begin() + std::ptrdiff_t((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// What reaches farther from the eye than this does not count: so many times as far as the middle one. Sorts the distances.
inline double far_limit(std::vector<double>& distances) {
    constexpr double far_away = 4.0;
    return distances.empty() ? std::numeric_limits<double>::infinity() : far_away * lower_median(distances);
}

}  // namespace tumble
