#include "compare/report/severity.h"

#include <algorithm>
#include <tuple>

namespace tumble {

double excess(const RuleFigure& figure) {
    constexpr double most = 1e6;
    // Similarity counts from 1 downwards. A limit of 0 allows nothing: any value exceeds it.
    const bool similarity = figure.metric == "ssim";
    const double value = similarity ? 1.0 - figure.value : figure.value;
    const double limit = similarity ? 1.0 - figure.limit : figure.limit;
    if (value <= 0.0) return 0.0;
    return limit > 0.0 ? std::min(value / limit, most) : most;
}

const RuleFigure* worst_figure(const ImageResult& result) {
    const auto worst = std::max_element(result.figures.begin(), result.figures.end(), [](const auto& a, const auto& b) {
        return std::pair(!a.holds, excess(a)) < std::pair(!b.holds, excess(b));
    });
    return worst == result.figures.end() ? nullptr : &*worst;
}

std::vector<const ImageResult*> by_severity(const SetResult& set) {
    std::vector<const ImageResult*> images;
    for (const ImageResult& image : set.images)
        if (image.verdict != Verdict::same) images.push_back(&image);
    const auto key = [](const ImageResult* image) {
        const RuleFigure* const worst = worst_figure(*image);
        return std::tuple(std::ranges::find(worst_first, image->verdict), worst ? -excess(*worst) : 0.0,
                          -image->differing_pixels);
    };
    std::stable_sort(images.begin(), images.end(), [&](const auto* a, const auto* b) { return key(a) < key(b); });
    return images;
}

}  // namespace tumble
