// What one frame draws: plain values made from the scene's looks and a snapshot, ready for upload.
// Bodies that share a mesh are one batch of instances, nearest first, so that what is hidden is rejected early.
#pragma once

#include "render/scene/render_scene.h"
#include "render/camera/camera.h"
#include "render/mesh/batch.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/shadow/shadow_cascades.h"
#include "sim/snapshot/snapshot.h"

#include <vector>

namespace tumble {

/// `wanted`, `casting`: of each item of drawn_items.h, whether it is to be drawn where it is visible, and into the shadow
/// maps.
DrawList make_draw_list(const SceneDescription& scene, const RenderScene& looks, const Snapshot& snapshot,
                        const Camera& view, const Visibility& visibility, const OcclusionAtlas& atlas,
                        const ShadowCascades& shadows, const std::vector<char>& wanted,
                        const std::vector<char>& casting);

}  // namespace tumble
