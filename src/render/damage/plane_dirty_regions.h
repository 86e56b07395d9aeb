// Regions where a plane must be drawn over the stored background, which has neither shadows nor occlusion: the cells
// that these may touch and that no box covers. Cells are those of CoarseDepthBuffer, merged into rectangles.
#pragma once

#include "core/rectangle.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/culling/occlusion_culling.h"
#include "render/damage/dirty_tiles.h"
#include "render/frame/frame_context.h"

#include <vector>

namespace tumble {

/// Within the dirty tiles. `atlas`: texels with occlusion (the AO radius of most bodies exceeds the visible effect).
std::vector<Rectangle> find_dirty_regions(const PlanePatch& plane, const FrameContext& frame,
                                          const CoarseDepthBuffer& cover, const OcclusionAtlas& atlas,
                                          const DirtyTiles& dirty);

}  // namespace tumble
