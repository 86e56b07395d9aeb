// Integer numbers of frames and steps from products of decimals: 4.35 * 100 is 434.99999999999994.
#pragma once

#include <algorithm>
#include <cmath>

namespace tumble {

/// The integer within a few roundings of x, otherwise x. Precondition: x >= 0.
inline double rounded_if_nearly_whole(double x) {
    constexpr double rounding = 1e-12;  // relative; about 4500 units in the last place
    const double nearest = std::nearbyint(x);
    return std::fabs(x - nearest) <= rounding * std::max(1.0, x) ? nearest : x;
}

}  // namespace tumble
