// A camera for scenes that name none: from the front, a little to the right and above, as near as the bodies allow.
#pragma once

#include "scene/description/description.h"

namespace tumble {

/// Keeps `lens.up` and `lens.vertical_fov` and chooses eye and target so that everything of note is in the picture:
/// all bodies but planes, moving ones at their start, at their keyframes and where they would drop to, and what is thrown on
/// its way in the first `seconds` (flights.h). Of a ground made of a body (fixed, and many times larger than all that moves)
/// only the part near the moving bodies counts. Where fixed bodies would hide what comes to lie in them it looks from higher up.
CameraDescription default_camera(const SceneDescription& scene, const CameraDescription& lens, double seconds = 0.0);

}  // namespace tumble
