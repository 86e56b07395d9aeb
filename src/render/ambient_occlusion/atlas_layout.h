// Where each body's texels are in the occlusion atlas: the same place for a whole clip. The atlas has a hard budget: where
// there are many bodies, all get coarser tiles.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"

namespace tumble {

/// Fills in the atlas' places, and its height so far.
void lay_out_places(const RenderScene& looks, OcclusionAtlas& atlas);

}  // namespace tumble
