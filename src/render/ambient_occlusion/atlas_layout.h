// The place of each body's texels in the AO atlas: constant over a clip. The atlas has a fixed budget; in a scene of
// many bodies all get coarser tiles.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"

namespace tumble {

/// Fills in the places of the atlas, and the height that they take.
void lay_out_places(const RenderScene& scene, OcclusionAtlas& atlas);

}  // namespace tumble
