// Constants of the soft contact solver.
#pragma once

#include <cstddef>

namespace tumble::tuning {

/// Natural frequency of a contact, cycles per substep: between two bodies; between bodies whose masses differ by
/// more than the factor `soft_unlike_masses`; against a body that does not move. One sweep per substep cannot
/// follow stiffer contacts: of 576 heaps of 27 boxes, 6 are awake after 8 s (0.25 for all: 52); a pyramid of 100
/// rows creeps by 3 mm in 60 s (0.22: by 0.13 m). Overlaps grow with the inverse square (bench_contact,
/// bench_stability "stack").
inline constexpr double soft_frequency = 0.16;
inline constexpr double soft_frequency_of_unlike = 0.14;
inline constexpr double soft_unlike_masses = 2.0;
inline constexpr double soft_frequency_of_fixed = 0.2;

/// Overlaps of this share of the smaller radius are corrected twice as fast, relative to their depth, except
/// between unlike masses: force chains in a heap end on single corners that carry 90 bodies (bench_contact "pile of
/// 8000"). Test: SoftKernel.AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved.
inline constexpr double soft_twice_as_stiff = 1e-2;

/// Least share of its compliance that a contact keeps when it is deeper than `correction_limit` allows: bodies of
/// millimeters still carry many times their weight, and a pressed body still gives way. Related test:
/// ContactHardInput.AMillimeterAndAHundredMeters.
inline constexpr double soft_least_give = 0.25;

/// Overlaps below this share of the smaller radius are not corrected: they keep the contact closed. Not fitted:
/// below any visible size. Test: SoftKernel.AnOverlapIsPushedOutSoftlyAndTheSpeedRemoved.
inline constexpr double soft_slop = 2e-5;

/// Least share of the compliance of a turn that is left where the anchors stay together. Not fitted: above the rounding
/// of single precision.
inline constexpr double soft_least_turn_gives = 1e-5;

}  // namespace tumble::tuning
