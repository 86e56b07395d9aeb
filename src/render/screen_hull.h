// Convex outlines on the screen.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace tumble {

using ScreenPoint = Eigen::Vector2d;   // pixels from the top left corner

/// Twice the area of the triangle a, b, c; positive when it turns from x to y.
inline double turn(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corners of the smallest convex polygon around the points, all turns positive. Fewer than three: no area.
std::vector<ScreenPoint> convex_hull(std::vector<ScreenPoint> points);

}  // namespace tumble
