// Damage by a body on a plane, its shadow and its occlusion; and the regions where a plane has either.
#pragma once

#include "core/image.h"
#include "render/ambient_occlusion/occlusion_atlas.h"
#include "render/culling/occlusion_culling.h"
#include "render/damage/dirty_tiles.h"
#include "render/frame/frame_context.h"

#include <vector>

namespace tumble {

/// Sine of the sun's elevation below which shadows are infinitely long.
inline constexpr double least_approach = 0.02;

/// The data of the sun for shadows on planes.
struct ShadowLight {
    bool shadows = true;
    Vec3 direction = Vec3::Zero();  // unit, direction in which the light travels
    ShadowCascades cascades;

    ShadowLight(const LightDescription& light, const ShadowCascades& shadow_cascades);

    /// Distance from a shadow's outline, across the light, within which a plane is affected that the light meets at an
    /// angle of this sine: texels.
    double filter_extent(double approach) const;

    /// Extent of the filter around the outline of this item's shadow, across the light, m.
    double margin(const DrawableBounds& item) const;

    /// The same on a plane that the light meets at an angle of this sine.
    double margin_on_plane(const DrawableBounds& item, double approach) const;
};

/// How far a drawable occludes a plane, m; 0: not at all.
struct PlaneOcclusionExtent {
    double ao_radius = 0.0;
    double blur = 0.0;  // by the interpolation between texels
};

/// Marks the drawable's shadow on the plane and its occlusion of the plane.
void mark_on_plane(const PlanePatch& plane, const DrawableBounds& item, const PlaneOcclusionExtent& occlusion,
                   const ShadowLight& light, const Camera& view, DirtyTiles& dirty);

/// False if mark_on_plane() certainly marks nothing in the given part of the frame: true of most bodies if little
/// changed.
bool may_touch(const PlanePatch& plane, const DrawableBounds& item, const PlaneOcclusionExtent& occlusion,
               const ShadowLight& light, const Camera& view, const Rectangle& part);

/// Regions within the dirty tiles where a plane must be drawn over the stored background, which has neither shadows nor
/// occlusion: the cells that these may touch and that no box covers. Cells are those of CoarseDepthBuffer, merged into
/// rectangles. `atlas`: texels with occlusion (the AO radius of most bodies exceeds the visible effect).
std::vector<Rectangle> find_dirty_regions(const PlanePatch& plane, const FrameContext& frame,
                                          const CoarseDepthBuffer& cover, const OcclusionAtlas& atlas,
                                          const DirtyTiles& dirty);

}  // namespace tumble
