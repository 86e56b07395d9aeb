#include "render/damage/plane_damage.h"

#include "render/camera/convex_hull_2d.h"
#include "render/scene/plane_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

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

namespace {

// The reciprocal of the depth is linear on the screen, so the nearest point of the plane in a cell is at a corner.
bool covered(int column, int row, const PlanePatch& plane, const Camera& view, const CoarseDepthBuffer& cover) {
    if (!std::isfinite(cover.depth(column, row))) return false;
    double most_fall = 0.0;  // height / depth at the nearest corner
    for (const int x : {column, column + 1})
        for (const int y : {row, row + 1})
            most_fall = std::max(most_fall,
                                 -plane.normal.dot(view.ray(x * CoarseDepthBuffer::cell, y * CoarseDepthBuffer::cell)));
    return cover.depth(column, row) * most_fall < plane.height * (1.0 - 1e-6);
}

constexpr int area_block = 4, longest_run = 32;  // texels

// Marks the runs of blocks with occlusion in the plane's tile of the atlas.
void mark_occlusion(const PlanePatch& plane, const OcclusionAtlas& atlas, const FrameContext& frame,
                    DirtyTiles& cells) {
    const auto tile = std::find_if(atlas.plane_tiles.begin(), atlas.plane_tiles.end(),
                                   [&](const PlaneOcclusionTile& w) { return w.body == plane.body; });
    if (tile == atlas.plane_tiles.end()) return;
    const BodyState& state = frame.snapshot.bodies[plane.body];
    const Camera& view = frame.camera;
    const PlaneAxes axes = plane_axes(frame.scene.bodies[plane.body].plane.normal);
    const Vec3 u = state.orientation * axes.u, v = state.orientation * axes.v, eye = view.eye() - state.origin;
    const auto place = [&](int i, int j) -> Vec3 {
        return u * ((tile->low_a + i) * tile->cell - u.dot(eye)) + v * ((tile->low_b + j) * tile->cell - v.dot(eye)) -
               plane.normal * plane.height;
    };
    const auto mark = [&](int left, int right, int top, int bottom) {  // interpolation: a texel affects its neighbors
        const std::array<Vec3, 4> corners{place(left - 1, top - 1), place(right, top - 1), place(right, bottom),
                                          place(left - 1, bottom)};
        if (view.sees(0.5 * (corners[0] + corners[2]), 0.5 * (corners[2] - corners[0]).norm()))
            cells.mark_hull(corners);
    };
    const auto dark = [&](int i, int j) {
        constexpr std::array<std::uint8_t, area_block> open{255, 255, 255, 255};
        const std::size_t columns = std::size_t(std::min(area_block, tile->width - i));
        for (int row = j; row < std::min(j + area_block, tile->height); ++row)
            if (std::memcmp(
                    &atlas.texels[std::size_t(tile->y + row) * OcclusionAtlas::width + std::size_t(tile->x + i)],
                    open.data(), columns) != 0)
                return true;
        return false;
    };
    for (int j = 0; j < tile->height; j += area_block)
        for (int i = 0, first = 0; i < tile->width; i += area_block) {
            const bool is_dark = dark(i, j),
                       ends = i + area_block >= tile->width || i + area_block - first >= longest_run;
            const int end = is_dark ? std::min(i + area_block, tile->width) : i;
            if (first < end && (!is_dark || ends)) mark(first, end, j, std::min(j + area_block, tile->height));
            if (!is_dark || ends) first = i + area_block;
        }
}

}  // namespace

std::vector<Rectangle> find_dirty_regions(const PlanePatch& plane, const FrameContext& frame,
                                          const CoarseDepthBuffer& cover, const OcclusionAtlas& atlas,
                                          const DirtyTiles& dirty) {
    constexpr int per_tile = DirtyTiles::tile / CoarseDepthBuffer::cell;
    static_assert(per_tile * CoarseDepthBuffer::cell == DirtyTiles::tile);
    DirtyTiles cells(frame.camera, CoarseDepthBuffer::cell);
    const ShadowLight light(frame.scene.light, frame.cascades);
    const Rectangle part = dirty.bounds();
    for (const std::vector<DrawableBounds>* casters : {&frame.drawables.bodies, &frame.drawables.cords})
        for (const DrawableBounds& caster : *casters)
            if (caster.exists() && !cells.all() && may_touch(plane, caster, {}, light, frame.camera, part))
                mark_on_plane(plane, caster, {}, light, frame.camera, cells);
    mark_occlusion(plane, atlas, frame, cells);
    // The plane is drawn neither outside the dirty tiles nor behind boxes. A rectangle costs ten microseconds, as much
    // as twenty such cells.
    const auto closed = [&](int column, int row) {
        return !dirty.at(column / per_tile, row / per_tile) || covered(column, row, plane, frame.camera, cover);
    };
    return cell_rectangles(
        cells.grid(), [&](int column, int row) { return cells.at(column, row) && !closed(column, row); }, closed);
}

}  // namespace tumble
