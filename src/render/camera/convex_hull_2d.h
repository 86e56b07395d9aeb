// Convex outlines on the screen.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace tumble {

using ScreenPoint = Eigen::Vector2d;   // pixels from the top left corner

/// Twice the area of the triangle a, b, c; positive when it turns from x to y.
inline double turn(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Some points, without a heap: hulls are made of a body's corners, thousands of them a frame.
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
    std::array<ScreenPoint, 2 * most> points_;   // a hull in the making has some that go again
    std::size_t count_ = 0;
};

/// The corners of the smallest convex polygon around the points, all turns positive. Fewer than three: no area.
FewPoints convex_hull(FewPoints points);

}  // namespace tumble
