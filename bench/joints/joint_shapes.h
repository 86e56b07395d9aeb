// Short constructors of joints and of hanging chains.
#pragma once

#include "harness/shapes.h"
#include "joints/watches.h"

namespace tumble::bench {

Joint ball_joint(std::size_t first, std::size_t second, const Vector& anchor);
Joint hinge_joint(std::size_t first, std::size_t second, const Vector& anchor, const Vector& axis);
Joint fixed_joint(std::size_t first, std::size_t second, const Vector& anchor);

/// The orientation that takes x to a direction in the plane of x and z.
Orientation along(const Vector& direction);

/// Links in the plane of x and z from the origin to (span, 0, 0), as they hang at rest on ball joints under gravity.
struct HangingChain {
    std::vector<Vector> joints;      // the first and the last lie at the ends
    std::vector<Vector> directions;  // of the links
};
HangingChain hanging(const std::vector<double>& masses, double link, double span);

}  // namespace tumble::bench
