#include "render/damage/dirty_tiles.h"

#include "core/check.h"
#include "render/camera/convex_hull_2d.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tumble {
namespace {

// One pixel for rounding by rasterization, and three for the neighbors used by antialiasing (gap_rows).
constexpr double tile_margin = 4.0;  // pixels

enum class ScreenArea { before, beside, behind };  // of points, relative to the eye

ScreenArea screen_area_of(std::span<const Vec3> points, const Camera& view) {
    bool before = false, behind = false;
    for (const Vec3& p : points) {
        const double depth = p.dot(view.forward());
        if (depth > 1e-3 * p.norm()) {
            before = true;
        } else if (depth < 0.0) {
            behind = true;
        } else {
            return ScreenArea::beside;
        }
    }
    if (before && behind) return ScreenArea::beside;
    return before ? ScreenArea::before : ScreenArea::behind;
}

int tile_of(double pixel, int size, int count) {
    return int(std::clamp(std::floor(pixel / size), -1.0, double(count)));
}

}  // namespace

DirtyTiles::DirtyTiles(const Camera& view, int size)
    : view_(&view),
      grid_{(view.width() + size - 1) / size, (view.height() + size - 1) / size, size, view.width(), view.height()},
      dirty_(std::size_t(grid_.columns) * std::size_t(grid_.rows), 0) {}

void DirtyTiles::mark_all() {
    std::fill(dirty_.begin(), dirty_.end(), char(1));
    count_ = grid_.columns * grid_.rows;
}

void DirtyTiles::mark(const Rectangle& rectangle) {
    for (int row = rectangle.y / grid_.cell; row * grid_.cell < rectangle.y + rectangle.height; ++row)
        for (int column = rectangle.x / grid_.cell; column * grid_.cell < rectangle.x + rectangle.width; ++column) {
            char& marked = dirty_[std::size_t(row * grid_.columns + column)];
            count_ += marked == 0 ? 1 : 0;
            marked = 1;
        }
}

void DirtyTiles::mark_hull(std::span<const Vec3> points, double around) {
    const ScreenArea place = screen_area_of(points, *view_);
    if (place == ScreenArea::behind || all()) return;
    if (place == ScreenArea::beside) return mark_all();
    TUMBLE_CHECK_LE(points.size(), FewPoints::most);
    FewPoints corners;
    double rim = tile_margin;  // pixels
    double leftmost = std::numeric_limits<double>::infinity(), rightmost = -leftmost;
    double top = leftmost, bottom = -leftmost;
    for (const Vec3& p : points) {
        corners.push_back(view_->pixel(p));
        if (around > 0.0) {  // for points nearer to the eye by this distance, the displacement on the screen is largest
            const double depth = p.dot(view_->forward()), nearest = depth - around;
            if (nearest < 0.1 * depth) return mark_all();
            rim = std::max(rim, tile_margin + around * p.norm() / (depth * nearest * view_->pixel_size()));
        }
        leftmost = std::min(leftmost, corners.back().x());
        rightmost = std::max(rightmost, corners.back().x());
        top = std::min(top, corners.back().y());
        bottom = std::max(bottom, corners.back().y());
    }
    if (all_marked(leftmost - rim, top - rim, rightmost + rim, bottom + rim)) return;  // the usual case in a heap
    // Small items need no finer test: the tiles around them are marked.
    if (rightmost - leftmost < grid_.cell && bottom - top < grid_.cell) {
        corners = {};
        for (const auto& [x, y] : {std::pair(leftmost, top), {rightmost, top}, {rightmost, bottom}, {leftmost, bottom}})
            corners.push_back({x, y});
    } else {
        corners = convex_hull(corners);
    }
    for (int row = std::max(0, tile_of(top - rim, grid_.cell, grid_.rows));
         row <= std::min(grid_.rows - 1, tile_of(bottom + rim, grid_.cell, grid_.rows)); ++row) {
        // Extent of the hull to both sides within this row of tiles.
        const double low = row * grid_.cell - rim, high = (row + 1) * grid_.cell + rim;
        double left = std::numeric_limits<double>::infinity(), right = -left;
        const auto include = [&](double x) {
            left = std::min(left, x);
            right = std::max(right, x);
        };
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const ScreenPoint &a = corners[i], &b = corners[(i + 1) % corners.size()];
            if (a.y() >= low && a.y() <= high) include(a.x());
            for (const double y : {low, high})
                if ((a.y() < y) != (b.y() < y)) include(a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y())));
        }
        for (int column = std::max(0, tile_of(left - rim, grid_.cell, grid_.columns));
             column <= std::min(grid_.columns - 1, tile_of(right + rim, grid_.cell, grid_.columns)); ++column) {
            char& mark = dirty_[std::size_t(row * grid_.columns + column)];
            count_ += mark == 0 ? 1 : 0;
            mark = 1;
        }
    }
}

bool DirtyTiles::all_marked(double x0, double y0, double x1, double y1) const {
    for (int row = std::max(0, tile_of(y0, grid_.cell, grid_.rows));
         row <= std::min(grid_.rows - 1, tile_of(y1, grid_.cell, grid_.rows)); ++row)
        for (int column = std::max(0, tile_of(x0, grid_.cell, grid_.columns));
             column <= std::min(grid_.columns - 1, tile_of(x1, grid_.cell, grid_.columns)); ++column)
            if (!at(column, row)) return false;
    return true;
}

bool DirtyTiles::touched_by(std::span<const Vec3> points) const {
    if (none()) return false;
    const ScreenArea place = screen_area_of(points, *view_);
    if (place == ScreenArea::behind) return false;
    if (place == ScreenArea::beside || all()) return true;
    double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
    for (const Vec3& p : points) {
        const ScreenPoint at = view_->pixel(p);
        x0 = std::min(x0, at.x());
        x1 = std::max(x1, at.x());
        y0 = std::min(y0, at.y());
        y1 = std::max(y1, at.y());
    }
    for (int row = std::max(0, tile_of(y0 - tile_margin, grid_.cell, grid_.rows));
         row <= std::min(grid_.rows - 1, tile_of(y1 + tile_margin, grid_.cell, grid_.rows)); ++row)
        for (int column = std::max(0, tile_of(x0 - tile_margin, grid_.cell, grid_.columns));
             column <= std::min(grid_.columns - 1, tile_of(x1 + tile_margin, grid_.cell, grid_.columns)); ++column)
            if (at(column, row)) return true;
    return false;
}

std::vector<Rectangle> DirtyTiles::rectangles() const {
    if (all()) return {{0, 0, grid_.width, grid_.height}};
    return cell_rectangles(grid_, [&](int column, int row) { return at(column, row); });
}

std::vector<Rectangle> DirtyTiles::rectangles_outside(const DirtyTiles& others) const {
    return cell_rectangles(grid_, [&](int column, int row) { return at(column, row) && !others.at(column, row); });
}

Rectangle DirtyTiles::bounds() const {
    int x0 = grid_.columns, y0 = grid_.rows, x1 = 0, y1 = 0;
    for (int row = 0; row < grid_.rows; ++row)
        for (int column = 0; column < grid_.columns; ++column) {
            if (!at(column, row)) continue;
            x0 = std::min(x0, column);
            x1 = std::max(x1, column + 1);
            y0 = std::min(y0, row);
            y1 = std::max(y1, row + 1);
        }
    if (x0 >= x1) return {0, 0, 0, 0};
    return {x0 * grid_.cell, y0 * grid_.cell, (x1 - x0) * grid_.cell, (y1 - y0) * grid_.cell};
}

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
