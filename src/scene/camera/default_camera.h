// Default camera of scenes without one: from the front, slightly from the right and above, as near as the bodies allow.
#pragma once

#include "scene/description/description.h"

namespace tumble {

/// Keeps `lens.up` and `lens.vertical_fov`. Chooses eye and target so that these are in the image:
/// - all bodies but planes, with moving ones at the start, at their keyframes and where they would drop to;
/// - thrown bodies on their trajectories in the first `seconds` (throw_preview.h);
/// - of a ground made of a body (fixed, and many times larger than all moving bodies) only the part near the moving
/// bodies.
/// Where fixed bodies would hide bodies in them, the camera is raised.
CameraDescription default_camera(const SceneDescription& scene, const CameraDescription& lens, double seconds = 0.0);

}  // namespace tumble
