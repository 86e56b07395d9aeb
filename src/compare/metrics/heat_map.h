// A metric's map as a picture.
#pragma once

#include "compare/metrics/metric_map.h"
#include "core/image.h"

namespace tumble {

/// Values from `cold` (black) over purple and orange to `hot` (light yellow); values beyond have the color of the
/// nearer end. `hot` may be less than `cold`: SSIM has 1 for equal pixels.
Image heat_map(const MetricMap& map, float cold = 0.0f, float hot = 1.0f);

}  // namespace tumble
