// The place of each body's texels in the AO atlas: constant over a clip. The atlas has a fixed budget; in a scene of
// many bodies all get coarser tiles.
#pragma once

#include "render/ambient_occlusion/occlusion_atlas.h"

namespace tumble {

/// Fills in the places of the atlas, and the height that they take.
void lay_out_places(const RenderScene& scene, OcclusionAtlas& atlas);

/// Allocates rectangles in the AO atlas on shelves (rows of rectangles): a rectangle is placed to the right of the
/// previous one if it fits below the shelf's height, otherwise on a new shelf.
class ShelfPacker {
public:
    ShelfPacker(int first_row, int most_rows) : row_(first_row), most_rows_(most_rows) {}

    /// False if there is no room.
    bool take(int width, int height, int& x, int& y) {
        if (width > OcclusionAtlas::width) return false;
        if (x_ + width > OcclusionAtlas::width || height > height_) {
            if (row_ + height_ + height > most_rows_) return false;
            row_ += height_;
            x_ = 0;
            height_ = height;
        }
        x = x_;
        y = row_;
        x_ += width;
        return true;
    }
    int end() const { return row_ + height_; }

private:
    int row_, most_rows_, x_ = 0, height_ = 0;
};

}  // namespace tumble
