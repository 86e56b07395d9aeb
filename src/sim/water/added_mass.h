// Water that a body sets in motion with it, by potential flow around the ellipsoid of the same box (Lamb 1932,
// "Hydrodynamics", sections 114 and 115).
#pragma once

#include "core/vector.h"

namespace tumble {

/// Per kg of displaced water, about the axes of the box.
struct AddedMass {
    Vec3 linear = Vec3::Zero();   // 1
    Vec3 angular = Vec3::Zero();  // m^2
};

/// `half`: m, half the edges of the box, all above 0. A ball has 1/2 and no angular part.
AddedMass added_mass_of(const Vec3& half);

}  // namespace tumble
