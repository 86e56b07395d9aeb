// Mean differences of windows, as rule `window` of compare/image_compare.h sees them, at each pixel.
#pragma once

#include "compare/metrics/metric_map.h"
#include "core/image.h"

namespace tumble {

/// The largest mean difference, levels, of the 8 x 8 windows that a pixel is in. Windows start at every fourth row and
/// column. Precondition: the sizes are equal.
MetricMap window_map(const Image& a, const Image& b);

}  // namespace tumble
