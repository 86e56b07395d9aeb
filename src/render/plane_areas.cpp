#include "render/plane_areas.h"

#include "render/occlusion_atlas.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// One over the depth is linear on the screen, so a cell's nearest point of the plane is at a corner.
bool covered(int column, int row, const PlanePatch& plane, const CameraView& view, const ScreenCover& cover) {
    if (!std::isfinite(cover.depth(column, row))) return false;
    double most_fall = 0.0;  // height / depth at the nearest corner
    for (const int x : {column, column + 1})
        for (const int y : {row, row + 1})
            most_fall =
                std::max(most_fall, -plane.normal.dot(view.ray(x * ScreenCover::cell, y * ScreenCover::cell)));
    return cover.depth(column, row) * most_fall < plane.height * (1.0 - 1e-6);
}

}  // namespace

std::vector<Rectangle> find_touched_areas(const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                                          const std::vector<DrawnItem>& items, const CameraView& view,
                                          const ShadowFit& shadows, const ScreenCover& cover, const TileMarks& marks) {
    constexpr int per_tile = TileMarks::tile / ScreenCover::cell;
    static_assert(per_tile * ScreenCover::cell == TileMarks::tile);
    TileMarks touched(view, ScreenCover::cell);
    const ShadowLight light(scene.light, shadows);
    const double blur = 1.5 * looks.window_cell;
    const Rectangle marked = marks.bounds();
    for (std::size_t i = 0; i < items.size() && !touched.all(); ++i) {
        const double reach = i < looks.bodies.size() ? looks.bodies[i].reach : 0.0;
        if (items[i].exists() && may_touch(plane, items[i], reach, blur, light, view, marked))
            mark_on_plane(plane, items[i], reach, blur, light, view, touched);
    }
    // Nothing of the plane is drawn outside of the marked tiles, nor behind boxes: each rectangle costs ten microseconds, as
    // much as twenty such cells.
    const auto closed = [&](int column, int row) {
        return !marks.at(column / per_tile, row / per_tile) || covered(column, row, plane, view, cover);
    };
    return cell_rectangles(
        touched.grid(), [&](int column, int row) { return touched.at(column, row) && !closed(column, row); }, closed);
}

}  // namespace tumble
