// The difference that a viewer perceives when two images alternate in one place: LDR-FLIP of Andersson, Nilsson,
// Akenine-Moeller, Oskarsson, Astroem and Fairchild 2020, "FLIP: A Difference Evaluator for Alternating Images", Proc.
// ACM Comput. Graph. Interact. Tech. 3 (2), 15:1-15:23. Each pixel has a value from 0 (equal) to 1.
#pragma once

#include "compare/metrics/metric_map.h"
#include "core/image.h"

namespace tumble {

struct FlipSettings {
    /// Pixels in a degree of the viewer's field of view. The default is the paper's: a monitor of 3840 pixels and 0.7 m
    /// at a distance of 0.7 m: 3840 pi/180.
    double pixels_per_degree = 67.0206432765823;
};

struct FlipResult {
    MetricMap map;
    double mean = 0.0;
    /// The value that half of the whole error lies above (resolution 1e-4): where there is a difference, it is about so
    /// large. Few pixels count as much as their error.
    double weighted_median = 0.0;
    double quantile_99 = 0.0;  // 1 % of the pixels are above (resolution 1e-4)
    double maximum = 0.0;
    int x = 0, y = 0;  // place of the maximum: the first from the top, then from the left
};

/// Precondition: the sizes are equal, and pixels_per_degree is in [1, 1000]. Images with alpha are seen on black and on
/// white, and the larger value counts. The bits of the result depend on the pixels only.
FlipResult flip(const Image& reference, const Image& image, const FlipSettings& settings = {});

}  // namespace tumble
