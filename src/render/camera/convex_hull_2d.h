// Convex outlines on the screen.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace tumble {

using ScreenPoint = Eigen::Vector2d;  // pixels from the top left corner

/// Twice the area of the triangle a, b, c; positive if it turns from x to y.
inline double turn(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// A small array on the stack: thousands of hulls of a body's corners are computed per frame.
class FewPoints {
public:
    static constexpr std::size_t most = 16;

    void push_back(const ScreenPoint& p) { points_[count_++] = p; }
    void pop_back() { --count_; }
    std::size_t size() const { return count_; }
    ScreenPoint* begin() { return points_.data(); }
    ScreenPoint* end() { return points_.data() + count_; }
    const ScreenPoint& operator[](std::size_t i) const { return points_[i]; }
    const ScreenPoint& back() const { return points_[count_ - 1]; }

private:
    std::array<ScreenPoint, 2 * most> points_;  // an unfinished hull holds points that are removed later
    std::size_t count_ = 0;
};

/// The corners of the convex hull of the points, all turns positive. Fewer than three: no area.
FewPoints convex_hull(FewPoints points);

}  // namespace tumble
