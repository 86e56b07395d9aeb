// The order of a report: the worst first.
#pragma once

#include "compare/comparison.h"

#include <vector>

namespace tumble {

/// The measured value in units of its limit: above 1 where the rule fails. At most 1e6.
double excess(const RuleFigure& figure);

/// The figure with the largest excess; null if there is none.
const RuleFigure* worst_figure(const ImageResult& result);

/// All images that are not the same: broken and missing ones, then those that differ by their largest excess, added
/// ones, and those within the tolerances.
std::vector<const ImageResult*> by_severity(const SetResult& set);

}  // namespace tumble
