// Regions where a plane must be drawn over the stored background, which has neither shadows nor occlusion: the cells
// that these may touch and that no box covers. Cells are those of CoarseDepthBuffer, merged into rectangles.
#pragma once

#include "core/rectangle.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/culling/occlusion_culling.h"
#include "render/damage/plane_damage.h"

#include <vector>

namespace tumble {

/// Within the marked tiles. `items`: possible casters; `atlas`: texels with occlusion (the AO radius of most bodies
/// exceeds the visible effect).
std::vector<Rectangle> find_dirty_regions(const PlanePatch& plane, const SceneDescription& description,
                                          const RenderScene& scene, const std::vector<DrawableBounds>& items,
                                          const Camera& view, const ShadowCascades& shadows,
                                          const CoarseDepthBuffer& cover, const OcclusionAtlas& atlas,
                                          const Snapshot& snapshot, const DirtyTiles& dirty);

}  // namespace tumble
