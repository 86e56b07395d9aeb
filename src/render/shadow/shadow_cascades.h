// The regions of the shadow maps. Two square maps (cascades) are perpendicular to the light. The near one is fixed for
// a clip, around the bodies' initial and estimated landing places as far as they are visible, so that resting shadows
// are the same in every frame. With a rotating camera all bodies count as visible; with a camera that follows a body,
// the map moves with it. The far one appears around it when a body or its shadow leaves it, with the near size times a
// power of two; a body outside the far map casts no shadow. The maps' texels are aligned to one grid in the world, so
// that shadows do not flicker. Everything depends on the scene and the one snapshot only, not on earlier frames.
#pragma once

#include "render/camera/camera.h"
#include "render/scene/render_scene.h"

#include <glm/vec4.hpp>

namespace tumble {

/// Texels across one map. A finer one costs more (1024: 1.3 ms a frame more) and has sharper edges.
inline constexpr int shadow_map_texels = 768;

/// Sampling of a shadow map (shaders/shadow.glsl). Lengths in texels.
struct ShadowFilter {
    bool by_pixel;  // true if a texel is smaller than a pixel, so that the filter width is that of the pixel
    double along;   // PCF kernel radius along each axis, texels
    double across;  // PCF kernel radius over both axes, texels
    double offset;  // normal offset bias, texels, against acne without gaps at contacts
    double lift;    // bias towards the sun, texels: against darkness before lit walls, from taps beyond them
    double extent;  // distance from a shadow's outline within which a point may be affected, texels
    friend bool operator==(const ShadowFilter&, const ShadowFilter&) = default;
};

/// Limits of the step to the next pixel, texels; the filter reads half a step to each side. Below the minimum, texels
/// would be visible; above the maximum, the maps' margins (5) would be too small.
inline constexpr double least_pixel_step = 1.5, most_pixel_step = 8.0;

inline constexpr ShadowFilter texel_filter{false, 2.0, 2.83, 2.2, 4.0, 6.0};
inline constexpr ShadowFilter pixel_filter{true, 0.5 * most_pixel_step + 1.0, 0.5 * most_pixel_step + 1.42, 1.6, 4.0,
                                           7.5};

struct ShadowCascades {
    int texels = 1;  // across each map
    ShadowFilter filter = texel_filter;
    glm::vec4 x, y, z;  // rows: position relative to the eye -> [0, 1]^2 of the near map, depth in [0, 1]
    bool has_far = false;
    glm::vec4 far{1.0f, 0.0f, 0.0f, 0.0f};     // near map -> far map: scale, offset x, offset y; w: 1 with a far map
    double near_texel = 0.0, far_texel = 0.0;  // m
    /// filter.along in the far map for pixels that read both maps: steps have at most the same length there, in meters.
    double far_along() const;
    /// True if a ball (relative to the eye) is within the near map and needs no far one.
    bool near_holds(const Vec3& center, double radius) const;
    /// True if a part of it may need the far one.
    bool may_look_far(const Vec3& center, double radius) const { return has_far && !near_holds(center, radius); }
    /// True if it is large and extends beyond the near map, so that each pixel has to select its map.
    bool spans_maps(const Vec3& center, double radius) const;

    friend bool operator==(const ShadowCascades&, const ShadowCascades&) = default;
};

class CascadeFitter {
public:
    /// `texels`: across each map; `view`: at the start.
    CascadeFitter(const SceneDescription& description, const RenderScene& scene, const Camera& view, int texels);

    /// `carried`: displacement of the camera with a followed body, m; the near map moves with it, by whole texels.
    ShadowCascades fit(const RenderScene& scene, const Snapshot& snapshot, const Camera& view,
                       const Vec3& carried = Vec3::Zero()) const;

    const ShadowFilter& filter() const { return filter_; }

private:
    Vec3 x_axis_, y_axis_, z_axis_;  // z: direction in which the light travels
    double size_;                    // of the near map, m
    double low_x_, low_y_;           // its corner, along the axes from the world's origin, m
    double middle_z_;                // depth of the bodies' middle at the start, m
    int texels_;
    ShadowFilter filter_ = texel_filter;
};

}  // namespace tumble
