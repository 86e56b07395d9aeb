// Which part of the world the shadow maps cover. Two square maps lie across the light: the near one is fixed for a clip
// (the bodies' first poses and where they will land, as far as they are in view), so that resting shadows are drawn
// alike in every frame. Where the camera turns, all of them; where it follows a body, the map does. The far one appears
// around it when a body or its shadow leaves it, in powers of two of its size, and what leaves even that throws no
// shadow. The maps' texels keep to one grid in the world: nothing crawls. All of it depends on the scene and the one
// snapshot only, never on frames drawn before.
#pragma once

#include "render/scene/render_scene.h"
#include "render/camera/camera.h"

#include <glm/vec4.hpp>

namespace tumble {

/// How a point looks into a map (shaders/shadow.glsl). Lengths in texels.
struct ShadowFilter {
    bool by_pixel;     // is a texel smaller than a pixel, so that the pixel's width is what is averaged over?
    double along;      // nearer are the texels' centers that are looked at, on each axis,
    double across;     // and on both
    double offset;     // along the normal, first of all: no acne, and contact stays closed
    double reach;      // both and some to spare: so far from a shadow's outline a point may see it
    friend bool operator==(const ShadowFilter&, const ShadowFilter&) = default;
};

/// Steps to the next pixel are taken so long at least and at most, texels; half of one is looked at to each side. Less than the
/// least and texels would show, more than the most and the maps' margins (5) would not do.
inline constexpr double least_pixel_step = 1.5, most_pixel_step = 8.0;

inline constexpr ShadowFilter texel_filter{false, 2.0, 2.83, 2.2, 6.0};
inline constexpr ShadowFilter pixel_filter{true, 0.5 * most_pixel_step + 1.0, 0.5 * most_pixel_step + 1.42, 1.6, 7.5};

struct ShadowCascades {
    int texels = 1;  // across each map
    ShadowFilter filter = texel_filter;
    glm::vec4 x, y, z;  // rows: position relative to the eye -> [0, 1]^2 of the near map, depth in [0, 1]
    bool has_far = false;
    glm::vec4 far{1.0f, 0.0f, 0.0f, 0.0f};     // near map -> far map: scale, offset x, offset y; w: 1 with a far map
    double near_texel = 0.0, far_texel = 0.0;  // m
    /// filter.along in the far map where pixels look into both: steps are no longer there, in meters.
    double far_along() const;
    /// Is a ball (relative to the eye) within the near map, so that nothing of it has to look into the far one?
    bool near_holds(const Vec3& center, double radius) const;
    /// May some of it look into the far one?
    bool may_look_far(const Vec3& center, double radius) const { return has_far && !near_holds(center, radius); }
    /// Is it so large, and not within the near map, that each of its pixels has to find out which map it lies in?
    bool spans_maps(const Vec3& center, double radius) const;

    friend bool operator==(const ShadowCascades&, const ShadowCascades&) = default;
};

class CascadeFitter {
public:
    /// `texels` across each map; `view` at the start.
    CascadeFitter(const SceneDescription& scene, const RenderScene& looks, const Camera& view, int texels);

    /// `carried`: how far a followed body has taken the camera, m; the near map goes along, by whole texels.
    ShadowCascades fit(const RenderScene& looks, const Snapshot& snapshot, const Camera& view,
                  const Vec3& carried = Vec3::Zero()) const;

    const ShadowFilter& filter() const { return filter_; }

private:
    Vec3 x_axis_, y_axis_, z_axis_;  // z: the way the light travels
    double size_;                    // of the near map, m
    double low_x_, low_y_;           // its corner, along the axes from the world's origin, m
    int texels_;
    ShadowFilter filter_ = texel_filter;
};

}  // namespace tumble
