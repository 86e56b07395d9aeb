#include "render/damage/shadow_dirty_tiles.h"

#include "render/damage/tile_merge.h"

#include <algorithm>
#include <cmath>

namespace tumble {

ShadowDirtyTiles::ShadowDirtyTiles(const ShadowCascades& cascades)
    : cascades_(cascades), maps_(cascades.has_far ? 2 : 1), dirty_(std::size_t(maps_ * count * count), 0) {}

void ShadowDirtyTiles::mark_all() { std::fill(dirty_.begin(), dirty_.end(), char(1)); }

bool ShadowDirtyTiles::none() const { return std::find(dirty_.begin(), dirty_.end(), char(1)) == dirty_.end(); }
bool ShadowDirtyTiles::all() const { return std::find(dirty_.begin(), dirty_.end(), char(0)) == dirty_.end(); }

// Cells from x0 to before x1; empty outside the map. The margin of one and a half texels is for rasterization.
ShadowDirtyTiles::Range ShadowDirtyTiles::range(const DrawableBounds& item, int map) const {
    const double scale = map == 1 ? cascades_.far.x : 1.0, shift_x = map == 1 ? cascades_.far.y : 0.0;
    const double shift_y = map == 1 ? cascades_.far.z : 0.0;
    const double half_width = scale * item.radius / (cascades_.near_texel * cascades_.texels) + 1.5 / cascades_.texels;
    const auto cell = [](double at) { return int(std::clamp(std::floor(at * count), -1.0, double(count))); };
    const auto span = [&](const glm::vec4& row, double shift, int& first, int& end) {
        const double near = row.x * item.center.x() + row.y * item.center.y() + row.z * item.center.z() + double(row.w);
        const double at = scale * near + shift;
        first = std::max(cell(at - half_width), 0);
        end = std::min(cell(at + half_width) + 1, count);
    };
    Range r{};
    span(cascades_.x, shift_x, r.x0, r.x1);
    span(cascades_.y, shift_y, r.y0, r.y1);
    return r;
}

void ShadowDirtyTiles::mark(const DrawableBounds& item) {
    for (int map = 0; map < maps_; ++map) {
        const Range r = range(item, map);
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x) dirty_[std::size_t((map * count + y) * count + x)] = 1;
    }
}

bool ShadowDirtyTiles::touched_by(const DrawableBounds& item) const {
    for (int map = 0; map < maps_; ++map) {
        const Range r = range(item, map);
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; ++x)
                if (dirty_[std::size_t((map * count + y) * count + x)] != 0) return true;
    }
    return false;
}

void ShadowDirtyTiles::settle() {
    const auto marked = std::count(dirty_.begin(), dirty_.end(), char(1));
    if (2 * marked > std::ptrdiff_t(dirty_.size())) mark_all();
}

std::vector<Rectangle> ShadowDirtyTiles::rectangles() const {
    const int texels = (cascades_.texels + count - 1) / count;
    std::vector<Rectangle> all;
    for (int map = 0; map < maps_; ++map)
        for (Rectangle part : cell_rectangles(
                 {count, count, texels, cascades_.texels, cascades_.texels},
                 [&](int column, int row) { return dirty_[std::size_t((map * count + row) * count + column)] != 0; })) {
            part.x += map * cascades_.texels;
            all.push_back(part);
        }
    return all;
}

}  // namespace tumble
