// Where a plane must be drawn over the background, which shows it without shadows and the bodies' darkening: in the cells
// that these may touch. Not where boxes cover it. Cells are those of CoarseDepthBuffer, joined into rectangles.
#pragma once

#include "core/rectangle.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/damage/plane_damage.h"
#include "render/culling/occlusion_culling.h"

#include <vector>

namespace tumble {

/// Within the marked tiles. `items`: what may throw shadows; `atlas`: what is darkened (most bodies' reach far beyond what a
/// texel tells).
std::vector<Rectangle> find_touched_areas(const PlanePatch& plane, const SceneDescription& scene, const RenderScene& looks,
                                          const std::vector<DrawableBounds>& items, const Camera& view,
                                          const ShadowCascades& shadows, const CoarseDepthBuffer& cover, const OcclusionAtlas& atlas,
                                          const Snapshot& snapshot, const DirtyTiles& marks);

}  // namespace tumble
