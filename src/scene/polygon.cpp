#include "scene/polygon.h"

#include <cmath>
#include <numeric>

namespace tumble {
namespace {

using Point = Eigen::Vector2d;

/// Twice the signed area of a triangle, positive when it turns counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corners in the plane that shows most of the polygon, counter-clockwise (Newell's normal; Sutherland 1974).
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
        if (turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) <= 0.0) return false;
    }
    // Turning left everywhere is not enough for a star that goes round twice: a fan would fold over.
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        if (turn(p[0], p[i], p[i + 1]) <= 0.0) return false;
    }
    return true;
}

bool is_ear(const std::vector<Point>& p, const std::vector<std::uint32_t>& left, std::size_t at) {
    const std::size_t n = left.size();
    const Point &a = p[left[(at + n - 1) % n]], &b = p[left[at]], &c = p[left[(at + 1) % n]];
    if (turn(a, b, c) <= 0.0) return false;
    for (std::size_t i = 2; i < n - 1; ++i) {
        const Point& q = p[left[(at + i) % n]];
        if (turn(a, b, q) >= 0.0 && turn(b, c, q) >= 0.0 && turn(c, a, q) >= 0.0) return false;
    }
    return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> cut_polygon(const std::vector<Vec3>& corners) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (corners.size() < 3) return triangles;
    const std::vector<Point> points = flattened(corners);
    std::vector<std::uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    const bool convex = is_strictly_convex(points);
    std::size_t at = 1, tried = 0;   // going on from the last ear finds the next one soon
    while (left.size() > 3) {
        const std::size_t n = left.size();
        at %= n;
        // When no corner is an ear the polygon is not simple: cut one off regardless.
        if (!convex && !is_ear(points, left, at) && ++tried < n) {
            ++at;
            continue;
        }
        triangles.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
        tried = 0;
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

}  // namespace tumble
