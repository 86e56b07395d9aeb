// Where on the screen a body changes the look of a plane.
#pragma once

#include "render/scene/drawable_bounds.h"
#include "render/scene/plane_patch.h"
#include "render/shadow/shadow_cascades.h"
#include "render/damage/dirty_tiles.h"

namespace tumble {

/// A lower sun throws shadows without end: the sine of its elevation.
inline constexpr double least_approach = 0.02;

/// The sun, as far as shadows on planes need it.
struct ShadowLight {
    bool shadows = true;
    Vec3 direction = Vec3::Zero();   // unit, the way the light travels
    ShadowCascades fit;

    ShadowLight(const LightDescription& light, const ShadowCascades& shadow_fit);

    /// How far from a shadow's outline, across the light, a plane may be touched that the light meets at an angle of this
    /// sine: texels.
    double filter_reach(double approach) const;

    /// How far the filter reaches around the outline of this item's shadow, across the light, m.
    double margin(const DrawableBounds& item) const;

    /// The same on a plane, which the light meets at an angle of this sine.
    double margin_on_plane(const DrawableBounds& item, double approach) const;
};

/// Marks the item's shadow on the plane, and its darkening of it within `reach` (m; 0: it has none), which is blurred
/// by `blur` (m).
void mark_on_plane(const PlanePatch& plane, const DrawableBounds& item, double reach, double blur, const ShadowLight& light,
                   const Camera& view, DirtyTiles& marks);

/// False when mark_on_plane() certainly marks nothing in a part of the picture: most bodies, where little changed.
bool may_touch(const PlanePatch& plane, const DrawableBounds& item, double reach, double blur, const ShadowLight& light,
               const Camera& view, const Rectangle& part);

}  // namespace tumble
