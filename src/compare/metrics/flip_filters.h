// The filters of FLIP (Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images", Proc. ACM Comput.
// Graph. Interact. Tech. 3 (2), 15) for a distance of the viewer.
#pragma once

#include "compare/metrics/row_filter.h"

namespace tumble {

/// The eye's resolution of each channel of YCxCz (sec. 4.1.1): contrast sensitivity functions as Gaussians. Cz has the
/// sum of two products: blue_yellow[0] along rows and columns, plus blue_yellow[1] along rows and columns.
struct ContrastFilters {
    RowFilter luminance, red_green, blue_yellow[2];
};

/// Detectors of edges and points (sec. 4.2): a Gaussian as wide as the lines that the eye detects, and its
/// first and second derivatives. The positive weights of a derivative sum to 1, and the negative ones to -1.
struct FeatureFilters {
    RowFilter gaussian, first_derivative, second_derivative;
};

ContrastFilters contrast_filters(double pixels_per_degree);
FeatureFilters feature_filters(double pixels_per_degree);

/// The largest radius of them all, pixels: farther away, a pixel has no effect.
int largest_radius(const ContrastFilters& contrast, const FeatureFilters& feature);

}  // namespace tumble
