// Which bodies get a fine surface: see fine_surface.h.
#pragma once

#include "render/scene/render_scene.h"

namespace tumble {

/// Gives one to fixed meshes and balls that are large beside what moves. Reaches and grounds must be known.
void choose_fine_surfaces(const SceneDescription& scene, RenderScene& looks);

}  // namespace tumble
