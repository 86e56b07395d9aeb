// A metric's map as a picture.
#pragma once

#include "compare/metrics/metric_map.h"
#include "core/image.h"

namespace tumble {

/// Values from 0 (black) over purple and orange to `hot` (light yellow); values beyond have the color of the nearer
/// end.
Image heat_map(const MetricMap& map, float hot = 1.0f);

}  // namespace tumble
