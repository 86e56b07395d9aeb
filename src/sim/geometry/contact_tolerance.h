// When two surfaces count as touching.
#pragma once

#include "sim/geometry/settings.h"


#include <algorithm>

namespace tumble {

/// Nearer than this (m) the surfaces of two bodies with these radii touch.
inline double touch_distance(double radius_a, double radius_b) { return tuning::touch * std::min(radius_a, radius_b); }

}  // namespace tumble
