// The picture of a convergence block: errors against the step on logarithmic axes, and the table of slopes.
#pragma once

#include "app/lesson/convergence.h"

#include <span>
#include <string>

namespace tumble {

/// <figure class="convergence">; its colors follow the page's theme.
std::string convergence_figure(const LessonConvergence& block, std::span<const ConvergenceLine> lines);

}  // namespace tumble
