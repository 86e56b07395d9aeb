// What several cases have told of them.
#pragma once

#include "contact/contact_case.h"

namespace tumble::bench {

/// Mean and largest penetration at the end (over pairs nearer than 1 cm), the fastest body there, and how many bodies
/// lie below the floor, z = 0.
std::unique_ptr<Witness> witness_of_overlap(const Scene& scene);

/// Does it stand: the largest way any body has gone sideways or down from where it began, and the largest penetration
/// at any look. `fallen` (m) is the way beyond which it has; the first time is told.
std::unique_ptr<Witness> witness_of_standing(const Scene& scene, double fallen);

}  // namespace tumble::bench
