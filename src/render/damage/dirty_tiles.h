// A set of tiles of the frame, for example those to redraw, or those with shadows on planes.
#pragma once

#include "core/rectangle.h"
#include "core/vector.h"
#include "render/camera/camera.h"
#include "render/damage/tile_merge.h"

#include <span>
#include <vector>

namespace tumble {

class DirtyTiles {
public:
    static constexpr int tile = 16;  // pixels: smaller tiles follow outlines better, but give many small rectangles

    explicit DirtyTiles(const Camera& view, int size = tile);

    void mark_all();

    /// Marks the tiles that the convex hull of the points (relative to the eye), enlarged by `around` (m), may touch on
    /// the screen, with a margin for rasterization and antialiasing. With a point beside the eye, all tiles are marked.
    void mark_hull(std::span<const Vec3> points, double around = 0.0);

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

}  // namespace tumble
