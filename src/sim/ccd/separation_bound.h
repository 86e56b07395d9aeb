// Lower bound of the time for which two bodies stay apart: second-order conservative advancement (after Mirtich 1996,
// "Impulse-based dynamic simulation of rigid body systems", section 2.3, with a bound on accelerations in place of
// speeds).
//
// Along an axis n(s) that rotates uniformly, the gap is f(s) = min over points b of B and a of A of n(s).(b(s) - a(s)),
// less the rounding. While f > 0 the axis separates the bodies: certainty needs no search for the true distance. Each
// pair's f_ab is known with its rate at s = 0 and f_ab'' >= -Q, so that f(s) >= min (f_ab + f_ab' s) - Q s^2 / 2, whose
// first root is found exactly. Near the impact the step's error is of second order: the search converges quadratically,
// and never passes over a first contact.
#pragma once

#include "sim/ccd/support_points.h"

namespace tumble {

struct SeparationBound {
    double gap = 0.0;        // m, f(0)
    double rate = 0.0;       // m/s, least rate of the nearest points
    double curvature = 0.0;  // m/s^2, Q
    double safe_time = 0.0;  // s; gaps below zero count as zero
};

/// Valid up to `horizon` s: safe_time is limited to it. `nearest` (m): points within it of the nearest pair count as
/// nearest.
SeparationBound bound_separation(const SupportPoints& a, const SupportPoints& b, const Axis& axis, double horizon,
                                 double nearest);

}  // namespace tumble
