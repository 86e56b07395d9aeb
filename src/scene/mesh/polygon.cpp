#include "scene/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace tumble {
namespace {

using Point = Eigen::Vector2d;

/// Twice the signed area of a triangle, positive if it turns counter-clockwise.
double orientation(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corners projected along the dominant axis of the normal, counter-clockwise (Newell's normal; Sutherland 1974).
std::vector<Point> flattened(const std::vector<Vec3>& corners) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 a = corners[i] - corners[0], b = corners[(i + 1) % corners.size()] - corners[0];
        normal += a.cross(b);
    }
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<Point> points;
    for (const Vec3& p : corners) points.emplace_back(p[u], normal[axis] < 0.0 ? -p[v] : p[v]);
    return points;
}

/// Convex with a true corner everywhere, so that every triangle of a fan has area.
bool is_strictly_convex(const std::vector<Point>& p) {
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (orientation(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) <= 0.0) return false;
    }
    // Left turns everywhere are not sufficient for a star that winds twice: a fan would fold over.
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        if (orientation(p[0], p[i], p[i + 1]) <= 0.0) return false;
    }
    return true;
}

/// Points of the plane in square cells, to find those within a triangle without visiting all.
class PointGrid {
public:
    explicit PointGrid(const std::vector<Point>& points) : points_(points), position_(points.size()) {
        Point max = points[0];
        min_ = points[0];
        for (const Point& p : points) min_ = min_.cwiseMin(p), max = max.cwiseMax(p);
        const double largest = std::max(min_.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff());
        const double extent = (max - min_).maxCoeff();
        // About one point per cell; a single cell if cells would be narrower than rounding.
        if (extent > fine * largest) side_ = std::size_t(std::ceil(std::sqrt(double(points.size()))));
        cell_size_ = extent / double(side_);
        cells_.resize(side_ * side_);
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            auto& cell =
                cells_[row_or_column(points[i].y() - min_.y()) * side_ + row_or_column(points[i].x() - min_.x())];
            position_[i] = {std::uint32_t(&cell - cells_.data()), std::uint32_t(cell.size())};
            cell.push_back(i);
        }
    }

    void remove(std::uint32_t point) {
        auto& cell = cells_[position_[point].cell];
        cell[position_[point].at] = cell.back();
        position_[cell.back()].at = position_[point].at;
        cell.pop_back();
    }

    /// A point within the triangle or on its edge that is not one of its corners, if any.
    std::optional<std::uint32_t> find_within(const std::array<std::uint32_t, 3>& corners) const {
        const Point &a = points_[corners[0]], &b = points_[corners[1]], &c = points_[corners[2]];
        const auto [first, last] = std::minmax({a.y(), b.y(), c.y()});
        for (std::size_t row = row_or_column(first - min_.y()); row <= row_or_column(last - min_.y()); ++row) {
            const auto [from, to] = columns(row, {a, b, c});
            for (std::size_t column = from; column <= to; ++column) {
                for (const std::uint32_t i : cells_[row * side_ + column]) {
                    const Point& q = points_[i];
                    if (orientation(a, b, q) >= 0.0 && orientation(b, c, q) >= 0.0 && orientation(c, a, q) >= 0.0 &&
                        i != corners[0] && i != corners[1] && i != corners[2])
                        return i;
                }
            }
        }
        return std::nullopt;
    }

private:
    // of the largest coordinate: far above its rounding, with a cell for each of 2000 points
    static constexpr double fine = 1e-9;

    std::size_t row_or_column(double distance) const {
        return cell_size_ > 0.0 ? std::min(std::size_t(std::max(distance / cell_size_, 0.0)), side_ - 1) : 0;
    }

    /// The first and the last column that the triangle reaches in a row, and one more on either side for rounding.
    std::pair<std::size_t, std::size_t> columns(std::size_t row, const std::array<Point, 3>& corners) const {
        const double low = min_.y() + (double(row) - 1.0) * cell_size_, high = low + 3.0 * cell_size_;
        double from = std::numeric_limits<double>::infinity(), to = -from;
        for (int i = 0; i < 3; ++i) {
            const Point &p = corners[i], &q = corners[(i + 1) % 3];
            const double rise = q.y() - p.y();
            for (const double y : {std::clamp(p.y(), low, high), std::clamp(q.y(), low, high)}) {
                const double t = rise != 0.0 ? std::clamp((y - p.y()) / rise, 0.0, 1.0) : y == p.y() ? 0.0 : 1.0;
                const double x = p.x() + t * (q.x() - p.x());
                from = std::min(from, x);
                to = std::max(to, x);
            }
        }
        const std::size_t first = row_or_column(from - min_.x()), last = row_or_column(to - min_.x());
        return {first > 0 ? first - 1 : 0, std::min(last + 1, side_ - 1)};
    }

    struct Position {
        std::uint32_t cell, at;
    };
    const std::vector<Point>& points_;
    std::vector<Position> position_;  // of each point
    std::vector<std::vector<std::uint32_t>> cells_;
    Point min_;
    double cell_size_ = 0.0;
    std::size_t side_ = 1;
};

/// Ear clipping in the order of a walk around the polygon. A corner that is no ear is not tested again until a
/// neighbor, or the point in its triangle, is removed.
class EarCutter {
public:
    explicit EarCutter(const std::vector<Point>& points)
        : points_(points),
          grid_(points),
          before_(points.size()),
          after_(points.size()),
          asked_(points.size(), true),
          removed_(points.size(), false),
          waiting_(points.size()),
          remaining_(points.size()) {
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            before_[i] = i > 0 ? i - 1 : std::uint32_t(points.size()) - 1;
            after_[i] = i + 1 < points.size() ? i + 1 : 0;
        }
    }

    std::vector<std::array<std::uint32_t, 3>> cut() {
        std::vector<std::array<std::uint32_t, 3>> triangles;
        std::uint32_t at = 1;
        while (remaining_ > 3) {
            // If no corner is an ear, the polygon is not simple: cut one off regardless.
            const std::uint32_t ear = next_ear(at).value_or(before_[at]);
            triangles.push_back(triangle(ear));
            at = after_[ear];
            remove(ear);
        }
        const std::uint32_t first = std::min({before_[at], at, after_[at]});
        triangles.push_back({first, after_[first], before_[first]});
        return triangles;
    }

private:
    std::array<std::uint32_t, 3> triangle(std::uint32_t corner) const {
        return {before_[corner], corner, after_[corner]};
    }

    std::optional<std::uint32_t> next_ear(std::uint32_t start) {
        const auto search = [&](std::size_t from, std::size_t to) -> std::optional<std::uint32_t> {
            for (auto found =
                     std::find(asked_.begin() + std::ptrdiff_t(from), asked_.begin() + std::ptrdiff_t(to), true);
                 found != asked_.begin() + std::ptrdiff_t(to);
                 found = std::find(found, asked_.begin() + std::ptrdiff_t(to), true)) {
                const auto corner = std::uint32_t(found - asked_.begin());
                if (is_ear(corner)) return corner;
                *found = false;
            }
            return std::nullopt;
        };
        const auto ear = search(start, asked_.size());
        return ear ? ear : search(0, start);
    }

    bool is_ear(std::uint32_t corner) {
        const auto t = triangle(corner);
        if (orientation(points_[t[0]], points_[t[1]], points_[t[2]]) <= 0.0) return false;
        const auto inside = grid_.find_within(t);
        if (inside) waiting_[*inside].push_back(corner);
        return !inside;
    }

    void remove(std::uint32_t corner) {
        after_[before_[corner]] = after_[corner];
        before_[after_[corner]] = before_[corner];
        grid_.remove(corner);
        remaining_ -= 1;
        for (const std::uint32_t other : waiting_[corner]) asked_[other] = !removed_[other];
        asked_[before_[corner]] = asked_[after_[corner]] = true;
        asked_[corner] = false;
        removed_[corner] = true;
    }

    const std::vector<Point>& points_;
    PointGrid grid_;
    std::vector<std::uint32_t> before_, after_;
    std::vector<bool> asked_;  // corners that may be ears
    std::vector<bool> removed_;
    std::vector<std::vector<std::uint32_t>> waiting_;  // for each point, corners with it in their triangle
    std::size_t remaining_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> cut_polygon(const std::vector<Vec3>& corners) {
    if (corners.size() < 3) return {};
    const std::vector<Point> points = flattened(corners);
    if (!is_strictly_convex(points)) return EarCutter(points).cut();
    std::vector<std::array<std::uint32_t, 3>> fan;
    for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) fan.push_back({0, i, i + 1});
    return fan;
}

}  // namespace tumble
