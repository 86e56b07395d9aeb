#include "render/plane_areas.h"

#include "render/cell_rectangles.h"
#include "render/plane_axes.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double rim = 2.0;            // pixels around what is touched: the atlas and the screen round too

enum class Use : unsigned char { open, touched, covered };

// The uses of all cells, which disks in the plane turn from open to touched.
class Cells {
public:
    Cells(const Vec3& normal, const CameraView& view, const ScreenCover& cover)
        : view_(view),
          axes_(plane_axes(normal)),
          columns_(cover.columns()),
          rows_(cover.rows()),
          uses_(std::size_t(columns_) * std::size_t(rows_), Use::open) {}

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    Use& at(int column, int row) { return uses_[std::size_t(row * columns_ + column)]; }

    void touch_everything() { std::fill(uses_.begin(), uses_.end(), Use::touched); }

    void touch_disk(const Vec3& center, double radius) {
        double x0 = std::numeric_limits<double>::infinity(), x1 = -x0, y0 = x0, y1 = -x0;
        for (const double a : {-radius, radius})
            for (const double b : {-radius, radius}) {
                const Vec3 p = center + a * axes_.u + b * axes_.v;
                if (!(p.dot(view_.forward()) > 1e-3 * p.norm())) return touch_everything();  // beside or behind the eye
                const Eigen::Vector2d pixel = view_.pixel(p);
                x0 = std::min(x0, pixel.x() - rim);
                x1 = std::max(x1, pixel.x() + rim);
                y0 = std::min(y0, pixel.y() - rim);
                y1 = std::max(y1, pixel.y() + rim);
            }
        const auto cell = [](double pixel, int count) {
            return int(std::clamp(std::floor(pixel / ScreenCover::cell), -1.0, double(count)));
        };
        for (int row = std::max(0, cell(y0, rows_)); row <= std::min(rows_ - 1, cell(y1, rows_)); ++row)
            for (int column = std::max(0, cell(x0, columns_)); column <= std::min(columns_ - 1, cell(x1, columns_));
                 ++column)
                at(column, row) = Use::touched;
    }

private:
    const CameraView& view_;
    PlaneAxes axes_;
    int columns_, rows_;
    std::vector<Use> uses_;
};

void touch_cells(Cells& cells, const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                 const Snapshot& snapshot, const CameraView& view, const ShadowFit& shadows) {
    const Vec3 light = scene.light.direction.normalized();
    const double approach = -plane.normal.dot(light);  // of the light to the plane: the sine of its elevation
    const double margin = shadow_filter_texels * (shadows.has_far ? shadows.far_texel : shadows.near_texel);
    if (scene.light.shadows && !scene.cords.empty()) return cells.touch_everything();  // cords are long: no good bound
    for (std::size_t i = 0; i < looks.bodies.size(); ++i) {
        const BodyLook& look = looks.bodies[i];
        if (look.kind == DrawKind::hidden || look.kind == DrawKind::plane) continue;
        const BoundingBall ball = bounding_ball(look, snapshot.bodies[i], view);
        const double height = plane.normal.dot(ball.center) + plane.height;
        if (height < -ball.radius) continue;
        if (height < ball.radius + 2.0 * look.reach && view.sees(ball.center, ball.radius + 2.0 * look.reach))
            cells.touch_disk(ball.center - height * plane.normal, ball.radius + 1.5 * look.reach);  // .5: texels blur
        if (scene.light.shadows && approach > 0.0 && view.sees_swept(ball.center, ball.radius, light)) {
            if (approach < 0.02) return cells.touch_everything();  // shadows without end
            cells.touch_disk(ball.center + light * (height / approach), (ball.radius + margin) / approach);
        }
    }
}

// One over the depth is linear on the screen, so a cell's nearest point of the plane is at a corner.
void cover_cells(Cells& cells, const PlanePatch& plane, const CameraView& view, const ScreenCover& cover) {
    for (int row = 0; row < cells.rows(); ++row)
        for (int column = 0; column < cells.columns(); ++column) {
            double most_fall = 0.0;  // height / depth at the nearest corner
            for (const int x : {column, column + 1})
                for (const int y : {row, row + 1})
                    most_fall =
                        std::max(most_fall, -plane.normal.dot(view.ray(x * ScreenCover::cell, y * ScreenCover::cell)));
            if (cover.depth(column, row) * most_fall < plane.height * (1.0 - 1e-6))
                cells.at(column, row) = Use::covered;
        }
}

std::vector<Rectangle> rectangles(Cells& cells, Use use, const CameraView& view, const TileMarks& marks) {
    constexpr int per_tile = TileMarks::tile / ScreenCover::cell;
    static_assert(per_tile * ScreenCover::cell == TileMarks::tile);
    const CellGrid grid{cells.columns(), cells.rows(), ScreenCover::cell, view.width(), view.height()};
    return cell_rectangles(grid, [&](int column, int row) { return cells.at(column, row) == use && marks.at(column / per_tile, row / per_tile);
    });
}

}  // namespace

PlaneAreas find_plane_areas(const PlanePatch& plane, const SceneDescription& scene, const SceneLooks& looks,
                            const Snapshot& snapshot, const CameraView& view, const ShadowFit& shadows,
                            const ScreenCover& cover, const TileMarks& marks) {
    Cells cells(plane.normal, view, cover);
    touch_cells(cells, plane, scene, looks, snapshot, view, shadows);
    cover_cells(cells, plane, view, cover);
    return {rectangles(cells, Use::touched, view, marks), rectangles(cells, Use::open, view, marks)};
}

}  // namespace tumble
