// The perceptual metrics of a pair of images that its tolerances ask for.
#pragma once

#include "compare/comparison.h"
#include "compare/tolerances.h"
#include "core/image.h"

#include <string>
#include <vector>

namespace tumble {

struct PerceptualFigure {
    RuleFigure figure;
    std::string reason;  // a sentence, for a figure beyond its limit
};

/// ssim and flip, as far as they have a limit. Precondition: the sizes are equal.
std::vector<PerceptualFigure> perceptual_figures(const Image& reference, const Image& image,
                                                 const PairTolerances& tolerances);

}  // namespace tumble
