// Selects the bodies that get a lightmap (occlusion_lightmap.h).
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

/// Gives lightmaps to fixed meshes and balls that are large relative to moving bodies. AO radii and large receivers
/// must be set before.
void select_lightmaps(const SceneDescription& description, RenderScene& scene);

}  // namespace tumble
