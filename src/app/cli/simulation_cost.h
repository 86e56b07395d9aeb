// The processor time that a simulation will take, for `tumble info`.
#pragma once

#include "scene/description/description.h"
#include "sim/world.h"

#include <string>

namespace tumble {

/// Steps the world, which is at time 0, for some seconds, and a coarse copy of it to the end, which shows how the cost of
/// later frames differs: heaps form, and bodies fall asleep. Says so where the simulation fails.
std::string simulation_cost(const SceneDescription& scene, World& world);

}  // namespace tumble
