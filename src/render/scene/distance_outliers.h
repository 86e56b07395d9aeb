// Excludes distance outliers: bodies so far from the eye that they are small on the screen, for example lost ones, do
// not affect quantities that are fitted to the other bodies.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace tumble {

/// The median; of an even number the lower of the two in the middle, because one of two bodies may be lost.
inline double lower_median(std::vector<double>& values) {
    const auto middle = values.begin() + std::ptrdiff_t((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Distance beyond which a body is an outlier: a multiple of the median distance. Sorts the distances.
inline double far_limit(std::vector<double>& distances) {
    constexpr double far_away = 4.0;
    return distances.empty() ? std::numeric_limits<double>::infinity() : far_away * lower_median(distances);
}

}  // namespace tumble
