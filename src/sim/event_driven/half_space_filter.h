// A fixed half-space in the world's frame: what most flying bodies have below them, told in a few numbers.
#pragma once

#include "sim/ccd/trajectory.h"

namespace tumble {

struct HalfSpaceFilter {
    Vec3 normal = Vec3::UnitY();
    double offset = 0.0;   // m: its surface is where normal . p is this
    bool valid = false;    // else this body is no half-space

    /// Whether a ball of this radius (m) about the centre of a body on the path certainly stays above for `horizon` s from
    /// the path's time `from` on: it is above, would be at the end, and does not fall and rise again in between.
    bool stays_below(const Trajectory& path, double radius, double from, double horizon) const;
};

}  // namespace tumble
