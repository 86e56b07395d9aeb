// Metrics shared by several cases.
#pragma once

#include "contact/contact_case.h"

namespace tumble::bench {

/// Mean and largest penetration at the end (over pairs nearer than 1 cm), the speed of the fastest body, and the number
/// of bodies below the floor, z = 0.
std::unique_ptr<Witness> witness_of_overlap(const Scene& scene);

/// Stability of a structure: the largest displacement of any body sideways or down from its start, and the largest
/// penetration at any observation. `fallen` (m): displacement beyond which it counts as fallen; the first such time is
/// reported.
std::unique_ptr<Witness> witness_of_standing(const Scene& scene, double fallen);

}  // namespace tumble::bench
