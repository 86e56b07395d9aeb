// The order of a report: the worst first.
#pragma once

#include "compare/comparison.h"

#include <vector>

namespace tumble {

/// The measured value in units of its limit: above 1 where the rule fails. At most 1e6.
double excess(const RuleFigure& figure);

/// The figure with the largest excess; null if there is none.
const RuleFigure* worst_figure(const ImageResult& result);

/// All images that are not the same, the worst verdict first, and then by their largest excess.
std::vector<const ImageResult*> by_severity(const SetResult& set);

}  // namespace tumble
