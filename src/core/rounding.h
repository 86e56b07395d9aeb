// Numbers of frames and steps out of products of decimals: 4.35 * 100 is 434.99999999999994.
#pragma once

#include <algorithm>
#include <cmath>

namespace tumble {

/// The whole number that x is within a few roundings of, else x. For x of 0 or more.
inline double whole_where_meant(double x) {
    constexpr double rounding = 1e-12;   // relative; about 4500 units in the last place
    const double nearest = std::nearbyint(x);
    return std::fabs(x - nearest) <= rounding * std::max(1.0, x) ? nearest : x;
}

}  // namespace tumble
