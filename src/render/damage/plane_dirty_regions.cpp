#include "render/damage/plane_dirty_regions.h"

#include "render/damage/plane_damage.h"
#include "render/scene/plane_axes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tumble {
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
