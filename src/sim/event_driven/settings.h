// Constants of event-driven motion (impacts = "exact").
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumble::tuning {

/// A touching contact that does not approach is no event while its overlap is below this share of the smaller body.
/// Not fitted: a tenth of the tolerance of resting contact. Tests: tests/sim/ccd/time_of_impact_test.cpp.
inline constexpr double impact_harmless = 1e-7;

/// Impacts of a resting body with others within a step at their own times, once it was hit. A body that turns about
/// a contact closes it repeatedly, by less each time. Not fitted: a bound of the cost. Related test:
/// BothRegimes.SeeSawGainsNothing.
inline constexpr int meetings_in_step = 8;

}  // namespace tumble::tuning
