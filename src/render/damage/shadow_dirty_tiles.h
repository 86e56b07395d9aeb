// The parts of the shadow maps that have to be drawn anew: a coarse lattice of cells over each, marked where a moved body
// was and is. Bodies that stand still are drawn again where they touch a marked cell; elsewhere that changes no depth.
#pragma once

#include "core/rectangle.h"
#include "render/scene/drawable_bounds.h"
#include "render/shadow/shadow_cascades.h"

#include <vector>

namespace tumble {

class ShadowDirtyTiles {
public:
    static constexpr int count = 24;   // cells to a side: 32 texels each

    explicit ShadowDirtyTiles(const ShadowCascades& fit);

    void mark_all();
    void mark(const DrawableBounds& item);
    bool touched_by(const DrawableBounds& item) const;

    /// Marks all where most is marked: one large rectangle is cheaper than many small ones.
    void settle();

    bool none() const;
    bool all() const;

    /// Texels of the texture that holds both maps, the near one first.
    std::vector<Rectangle> rectangles() const;

private:
    struct Range {
        int x0, x1, y0, y1;
    };
    Range range(const DrawableBounds& item, int map) const;

    ShadowCascades fit_;
    int maps_;                  // 2 with a far one
    std::vector<char> marks_;   // map by map, row by row
};

}  // namespace tumble
