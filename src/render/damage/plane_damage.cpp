#include "render/damage/plane_damage.h"

#include "render/camera/convex_hull_2d.h"
#include "render/scene/plane_axes.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Corners of the rectangle, along the plane's axes, around the projections of all corners, enlarged by `margin` (m).
std::array<Vec3, 4> foot_print(const PlanePatch& plane, const DrawableBounds& item, double margin) {
    const PlaneAxes axes = plane_axes(plane.normal);
    double low_u = std::numeric_limits<double>::infinity(), high_u = -low_u, low_v = low_u, high_v = -low_u;
    for (const Vec3& corner : item.corners()) {
        const double u = axes.u.dot(corner), v = axes.v.dot(corner);
        low_u = std::min(low_u, u - margin);
        high_u = std::max(high_u, u + margin);
        low_v = std::min(low_v, v - margin);
        high_v = std::max(high_v, v + margin);
    }
    std::array<Vec3, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
        points[i] = axes.u * ((i & 1) != 0 ? high_u : low_u) + axes.v * ((i & 2) != 0 ? high_v : low_v) -
                    plane.normal * plane.height;
    return points;
}

}  // namespace

ShadowLight::ShadowLight(const LightDescription& light, const ShadowCascades& shadow_cascades)
    : shadows(light.shadows), direction(light.direction.normalized()), cascades(shadow_cascades) {}

// The displacement across the light by the normal offset is smaller for steeper light; half a texel is the margin.
double ShadowLight::filter_extent(double approach) const {
    return cascades.filter.across + cascades.filter.offset * std::sqrt(std::max(1.0 - approach * approach, 0.0)) + 0.5;
}

double ShadowLight::margin(const DrawableBounds& item) const {
    const double near = cascades.filter.extent * cascades.near_texel;
    if (!cascades.may_look_far(item.center, item.radius + near)) return near;  // its shadow is in the near map as well
    return cascades.filter.extent * cascades.far_texel;
}

double ShadowLight::margin_on_plane(const DrawableBounds& item, double approach) const {
    return margin(item) * std::min(filter_extent(approach) / cascades.filter.extent, 1.0);
}

void mark_on_plane(const PlanePatch& plane, const DrawableBounds& item, const PlaneOcclusionExtent& occlusion,
                   const ShadowLight& light, const Camera& view, DirtyTiles& dirty) {
    const double height = plane.normal.dot(item.center) + plane.height;
    if (height < -item.radius) return;
    if (occlusion.ao_radius > 0.0 && height < item.radius + 2.0 * occlusion.ao_radius &&
        view.sees(item.center, item.radius + 2.0 * occlusion.ao_radius))
        dirty.mark_hull(foot_print(plane, item, occlusion.ao_radius + occlusion.blur));
    const double approach = -plane.normal.dot(light.direction);
    if (!light.shadows || approach <= 0.0 || !view.sees_swept(item.center, item.radius, light.direction)) return;
    if (approach < least_approach) return dirty.mark_all();
    std::array<Vec3, 8> feet = item.corners();
    for (Vec3& foot : feet) foot += light.direction * ((plane.normal.dot(foot) + plane.height) / approach);
    dirty.mark_hull(feet, light.margin_on_plane(item, approach) / approach);
}

bool may_touch(const PlanePatch& plane, const DrawableBounds& item, const PlaneOcclusionExtent& occlusion,
               const ShadowLight& light, const Camera& view, const Rectangle& part) {
    constexpr double margin = 8.0;  // pixels: more than the margin of DirtyTiles
    const double height = plane.normal.dot(item.center) + plane.height;
    const auto meets = [&](const Vec3& center, double radius) {
        const double depth = center.dot(view.forward()), nearest = depth - radius;
        if (nearest < 0.1 * center.norm()) return true;  // near the eye, or far beside it: undecided
        const ScreenPoint at = view.pixel(center);
        const double around = radius * center.norm() / (depth * nearest * view.pixel_size()) + margin;
        return at.x() + around >= part.x && at.x() - around <= part.x + part.width && at.y() + around >= part.y &&
               at.y() - around <= part.y + part.height;
    };
    // The corners of a ball's box are 1.74 radii from its center; a rectangle around them extends 1.42 times as far,
    // and an oblique shadow twice as far, over the sine of the elevation.
    if (meets(item.center - plane.normal * height, 2.5 * (item.radius + occlusion.ao_radius + occlusion.blur)))
        return true;
    const double approach = -plane.normal.dot(light.direction);
    if (!light.shadows || approach <= 0.0) return false;
    return meets(item.center + light.direction * (height / approach),
                 (3.5 * item.radius + light.margin(item)) / approach);
}

}  // namespace tumble
