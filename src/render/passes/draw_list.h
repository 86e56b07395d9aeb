// The draw list of one frame: plain values made from the frame, ready for upload. Bodies that share a mesh form one
// batch of instances, nearest first, so that hidden pixels are rejected early.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/culling/occlusion_culling.h"
#include "render/frame/frame_context.h"
#include "render/mesh/batch.h"

namespace tumble {

/// `drawn`, `casters`: drawables to draw into the frame and into the shadow maps.
DrawList make_draw_list(const FrameContext& frame, const Visibility& visible, const OcclusionAtlas& atlas,
                        const DrawableMask& drawn, const DrawableMask& casters);

}  // namespace tumble
