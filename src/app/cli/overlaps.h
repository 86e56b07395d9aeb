// Bodies that overlap at the start: the contact pushes them apart, with energy out of nothing.
#pragma once

#include "scene/description/description.h"
#include "sim/world.h"

#include <string>

namespace tumble {

/// Lines that name them; empty where there are none. Precondition: the world is at time 0.
std::string overlap_warning(const SceneDescription& scene, const World& world);

}  // namespace tumble
