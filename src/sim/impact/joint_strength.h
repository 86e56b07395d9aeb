// Joints that break in an impact.
//
// Let d1 be the change of velocities with all joints, and d0 that without those whose strength it exceeds, the worst by
// a factor k > 1. The change is d0 + (d1 - d0) / k: the worst joint gives its strength, and then breaks. The conditions
// of an impact are convex, so the mean has what both have: it keeps momenta, stops every approach, keeps friction
// within its discs, and has no more energy than the mean of both energies.
#pragma once

#include "sim/impact/impacts.h"

namespace tumble {

/// Takes out gears one of whose joints the island lacks: it has broken.
void drop_loose_gears(Island& island);

/// resolve_impacts() with the strengths of the joints. `broken`: gets joints that break; their states are not changed.
int resolve_breaking(const Island& island, std::vector<Contact>& contacts, std::vector<Body>& bodies,
                     const ImpactSettings& settings, ImpactTrace* trace, std::vector<JointImpulse>& joint_impulses,
                     std::vector<Joint*>& broken);

}  // namespace tumble
