// A fixed half-space in the world frame: a quick test of ballistic bodies above it.
#pragma once

#include "sim/ccd/trajectory.h"

namespace tumble {

struct HalfSpaceFilter {
    Vec3 normal = Vec3::UnitY();
    double offset = 0.0;  // m: normal . p of its surface
    bool valid = false;   // else this body is no half-space

    /// Whether a ball of this radius (m) about the center of a body certainly stays above for `horizon` s from the
    /// trajectory's time `from` on: it is above at the start and at the end, and does not fall and rise again in
    /// between.
    bool stays_below(const Trajectory& path, double radius, double from, double horizon) const;
};

}  // namespace tumble
