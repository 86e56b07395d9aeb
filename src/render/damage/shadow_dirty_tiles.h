// The parts of the shadow maps to redraw: a coarse grid of cells over each, marked at the old and the new pose of a
// moved body. Bodies that stand still are redrawn where they touch a marked cell; in other cells that changes no depth.
#pragma once

#include "core/rectangle.h"
#include "render/scene/drawable_bounds.h"
#include "render/shadow/shadow_cascades.h"

#include <vector>

namespace tumble {

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
