// The gap below which two surfaces count as touching.
#pragma once

#include "sim/geometry/settings.h"

#include <algorithm>

namespace tumble {

/// Contact tolerance (m) of two bodies with these radii.
inline double touch_distance(double radius_a, double radius_b) { return tuning::touch * std::min(radius_a, radius_b); }

}  // namespace tumble
