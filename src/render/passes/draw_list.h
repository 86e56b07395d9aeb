// The draw list of one frame: plain values made from the render scene and a snapshot, ready for upload. Bodies that
// share a mesh form one batch of instances, nearest first, so that hidden pixels are rejected early.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/camera/camera.h"
#include "render/mesh/batch.h"
#include "render/scene/render_scene.h"
#include "render/shadow/shadow_cascades.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble {

/// `draw_mask`, `caster_mask`: draw mask and caster mask, by item of drawable_bounds.h.
DrawList make_draw_list(const SceneDescription& description, const RenderScene& scene, const Snapshot& snapshot,
                        const Camera& view, const Visibility& visibility, const OcclusionAtlas& atlas,
                        const ShadowCascades& shadows, const std::vector<char>& draw_mask,
                        const std::vector<char>& caster_mask);

}  // namespace tumble
