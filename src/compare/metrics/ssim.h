// Structural similarity: Wang, Bovik, Sheikh and Simoncelli 2004, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", IEEE Trans. Image Process. 13 (4), 600-612. Each pixel has a value from -1 to 1 (equal), of
// the Gaussian window around it. Of luma only: a change of color alone is invisible to it.
#pragma once

#include "compare/metrics/metric_map.h"
#include "core/image.h"

namespace tumble {

struct SsimResult {
    MetricMap map;
    /// Over the windows inside the image, as the authors do; over all pixels where a side is shorter than a window.
    double mean = 1.0;
    double lowest = 1.0;
    int x = 0, y = 0;  // place of the lowest: the first from the top, then from the left
};

/// Precondition: the sizes are equal. Images with alpha are seen on black and on white, and the lower value counts. The
/// bits of the result depend on the pixels only.
SsimResult ssim(const Image& reference, const Image& image);

}  // namespace tumble
