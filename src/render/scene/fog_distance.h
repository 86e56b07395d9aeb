// Reference distance of a clip, for fog and the grids of planes: constant over the clip, so that neither jumps.
#pragma once

#include "render/scene/render_scene.h"
#include "scene/description/description.h"

namespace tumble {

/// Distance from the eye to the target (with keyframes, the largest), if the bodies are at about that distance; a scene
/// may place the target anywhere along the view direction. m, from the initial poses.
double viewing_distance(const SceneDescription& description, const RenderScene& scene);

/// Distance at which fog is half of the light, m: a multiple of the reference distance, or farther so that bodies that
/// are large on the screen stay visible at any distance.
double fog_distance(const SceneDescription& description, const RenderScene& scene, double viewing_distance);

}  // namespace tumble
