// Sets of tiles: of the frame, for example tiles to redraw, or tiles with shadows on planes; and of the shadow maps.
#pragma once

#include "core/image.h"
#include "core/vector.h"
#include "render/camera/camera.h"
#include "render/scene/drawable_bounds.h"
#include "render/shadow/shadow_cascades.h"

#include <algorithm>
#include <span>
#include <vector>

namespace tumble {

/// A grid of cells over the frame, which are merged into few rectangles.
struct CellGrid {
    int columns = 0, rows = 0;
    int cell = 1;               // pixels
    int width = 0, height = 0;  // of the frame, pixels; the last column and row may be cut off
};

/// The rectangles of all cells for which `selected(column, row)` is true, in pixels: runs along a row, extended
/// downward while the rows below have the same run. They do not overlap. They may include cells for which `free(column,
/// row)` is true where that makes fewer rectangles.
template <class Selected, class Free>
std::vector<Rectangle> cell_rectangles(const CellGrid& grid, Selected selected, Free free) {
    enum Cell : char { none, spare, needed };
    std::vector<char> left(std::size_t(grid.columns) * std::size_t(grid.rows));
    const auto at = [&](int column, int row) -> char& { return left[std::size_t(row * grid.columns + column)]; };
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            at(column, row) = selected(column, row) ? needed : free(column, row) ? spare : none;
    std::vector<Rectangle> rectangles;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            if (at(column, row) != needed) continue;
            int end = column, bottom = row;
            for (int x = column; x < grid.columns && at(x, row) != none; ++x)
                if (at(x, row) == needed) end = x + 1;
            const auto same_run = [&](int y) {
                if (column > 0 && at(column - 1, y) == needed) return false;
                if (end < grid.columns && at(end, y) == needed) return false;
                bool any = false;
                for (int x = column; x < end; ++x) {
                    if (at(x, y) == none) return false;
                    any = any || at(x, y) == needed;
                }
                return any;
            };
            do {
                for (int x = column; x < end; ++x) at(x, bottom) = none;
                ++bottom;
            } while (bottom < grid.rows && same_run(bottom));
            const int x = column * grid.cell, y = row * grid.cell;
            rectangles.push_back(
                {x, y, std::min(end * grid.cell, grid.width) - x, std::min(bottom * grid.cell, grid.height) - y});
        }
    return rectangles;
}

template <class Selected>
std::vector<Rectangle> cell_rectangles(const CellGrid& grid, Selected selected) {
    return cell_rectangles(grid, selected, [](int, int) { return false; });
}

/// Tiles of the frame.
class DirtyTiles {
public:
    static constexpr int tile = 16;  // pixels: smaller tiles follow outlines better, but give many small rectangles

    explicit DirtyTiles(const Camera& view, int size = tile);

    void mark_all();

    /// Marks the tiles that the convex hull of the points (relative to the eye), enlarged by `around` (m), may touch on
    /// the screen, with a margin for rasterization and antialiasing. With a point beside the eye, all tiles are marked.
    void mark_hull(std::span<const Vec3> points, double around = 0.0);

    /// Marks the tiles that the rectangle (in pixels of the frame) touches.
    void mark(const Rectangle& rectangle);

    bool none() const { return count_ == 0; }
    bool all() const { return count_ == grid_.columns * grid_.rows; }
    bool at(int column, int row) const { return dirty_[std::size_t(row * grid_.columns + column)] != 0; }

    /// True if the bounding rectangle of the points' convex hull touches a marked tile.
    bool touched_by(std::span<const Vec3> points) const;

    const CellGrid& grid() const { return grid_; }
    std::vector<Rectangle> rectangles() const;
    std::vector<Rectangle> rectangles_outside(
        const DirtyTiles& others) const;  // of tiles that are not marked in `others`

    /// The bounding rectangle of the marked tiles.
    Rectangle bounds() const;

private:
    bool all_marked(double x0, double y0, double x1, double y1) const;  // in this part of the screen, pixels

    const Camera* view_;
    CellGrid grid_;
    std::vector<char> dirty_;
    int count_ = 0;  // of marked tiles
};

/// The parts of the shadow maps to redraw: a coarse grid of cells over each, marked at the old and the new pose of a
/// moved body. Bodies that stand still are redrawn where they touch a marked cell; in other cells that changes no
/// depth.
class ShadowDirtyTiles {
public:
    static constexpr int count = 24;  // cells per side: 32 texels each

    explicit ShadowDirtyTiles(const ShadowCascades& cascades);

    void mark_all();
    void mark(const DrawableBounds& item);
    bool touched_by(const DrawableBounds& item) const;

    /// Marks all cells if most are marked: one large rectangle is cheaper than many small ones.
    void settle();

    bool none() const;
    bool all() const;

    /// In texels of the texture that holds both maps, the near one first.
    std::vector<Rectangle> rectangles() const;

private:
    struct Range {
        int x0, x1, y0, y1;
    };
    Range range(const DrawableBounds& item, int map) const;

    ShadowCascades cascades_;
    int maps_;                 // 2 with a far map
    std::vector<char> dirty_;  // map by map, row by row
};

}  // namespace tumble
