// Visible joints: cords that look like their pins, axles and rods.
#pragma once

#include "scene/description/description.h"

#include <vector>

namespace tumble {

/// The drawing of a joint other than a distance joint: cylinders fixed in one of its bodies.
std::vector<CordDescription> pins_of(const SceneDescription& scene, std::size_t joint);

}  // namespace tumble
