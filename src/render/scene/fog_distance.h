// How far away what a clip shows is: what distance haze and the grids of planes fit, the same for all of it, so that they never
// jump.
#pragma once

#include "render/scene/render_scene.h"
#include "scene/description/description.h"

namespace tumble {

/// From the eye to the target (of keyframes, the farthest), as long as the bodies are about there: who writes an eye and a direction
/// may put the target anywhere along it. m, by where everything starts.
double viewing_distance(const SceneDescription& scene, const RenderScene& looks);

/// Where half of a thing's light is haze, m: some viewing distances away, or so far that what is large in the picture is not lost
/// in it, however far it is.
double fog_distance(const SceneDescription& scene, const RenderScene& looks, double viewing_distance);

}  // namespace tumble
