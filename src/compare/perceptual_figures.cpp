#include "compare/perceptual_figures.h"

#include "compare/metrics/flip.h"
#include "compare/metrics/ssim.h"

#include <fmt/format.h>

namespace tumble {
namespace {

PerceptualFigure ssim_figure(const Image& reference, const Image& image, double limit) {
    const SsimResult found = ssim(reference, image);
    const RuleFigure figure{"ssim", found.mean, limit, found.mean >= limit, found.x, found.y};
    return {figure,
            fmt::format("rule ssim: the structural similarity is {:.6g} (at least {:.6g} is needed; key ssim); the "
                        "lowest at x {}, y {}",
                        found.mean, limit, found.x, found.y)};
}

PerceptualFigure flip_figure(const Image& reference, const Image& image, double limit) {
    const FlipResult found = flip(reference, image);
    const RuleFigure figure{"flip", found.mean, limit, found.mean <= limit, found.x, found.y};
    return {figure, fmt::format("rule flip: the mean perceptual error is {:.6g} (at most {:.6g} may be; key flip); the "
                                "largest at x {}, y {}",
                                found.mean, limit, found.x, found.y)};
}

}  // namespace

std::vector<PerceptualFigure> perceptual_figures(const Image& reference, const Image& image,
                                                 const PairTolerances& tolerances) {
    std::vector<PerceptualFigure> figures;
    if (tolerances.ssim) figures.push_back(ssim_figure(reference, image, *tolerances.ssim));
    if (tolerances.flip) figures.push_back(flip_figure(reference, image, *tolerances.flip));
    return figures;
}

}  // namespace tumble
