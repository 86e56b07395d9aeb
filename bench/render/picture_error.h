// Difference of an image from a reference, overall and at edges.
#pragma once

#include "core/image.h"

#include <vector>

namespace tumble::bench {

/// Mean and standard deviation of many images of one scene with subpixel shifts.
class PictureMean {
public:
    void add(const Image& image);

    /// The mean, rounded.
    Image mean() const;

    /// Pixels on an edge: the standard deviation of the brightness over the images exceeds 8 levels.
    std::vector<bool> edges() const;

private:
    int width_ = 0, height_ = 0, count_ = 0;
    std::vector<double> sum_, squares_;  // sums of the four channels; of the squared brightness
};

/// Root of the mean squared difference over red, green and blue of the selected pixels, levels.
double rms_difference(const Image& a, const Image& b, const std::vector<bool>& chosen);

/// Wang, Bovik, Sheikh, Simoncelli 2004, "Image quality assessment": mean structural similarity of the brightness, over
/// 8 x 8 windows.
double structural_similarity(const Image& a, const Image& b);

}  // namespace tumble::bench
