#include "render/mesh/triangle_distance.h"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

// Largest number of cells per side, for any distance.
constexpr double most_cells = 64.0;
constexpr std::int64_t row = 1 << 20;  // stride of cell indices

Bounds bounds_of(const NearSurface::Triangle& t) {
    Bounds bounds;
    for (const Vec3& corner : t) bounds.add(corner);
    return bounds;
}

}  // namespace

// Ericson 2004, Real-Time Collision Detection, 5.1.5: the regions of a triangle's plane by barycentric signs.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0.0 && d2 <= 0.0) return ap.norm();
    if (d3 >= 0.0 && d4 <= d3) return bp.norm();
    if (d6 >= 0.0 && d5 <= d6) return cp.norm();
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (ap - ab * (d1 / (d1 - d3))).norm();
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (ap - ac * (d2 / (d2 - d6))).norm();
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).norm();
    const double sum = va + vb + vc;
    return sum > 0.0 ? (ap - ab * (vb / sum) - ac * (vc / sum)).norm() : ap.norm();
}

NearSurface::NearSurface(std::vector<Triangle> triangles, double within)
    : triangles_(std::move(triangles)), within_(within) {
    Bounds all;
    for (const Triangle& t : triangles_)
        for (const Vec3& corner : t) all.add(corner);
    low_ = all.min;
    cell_ = std::max({within, all.extent().maxCoeff() / most_cells, 1e-300});
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Bounds bounds = bounds_of(triangles_[i]);
        const auto range = [&](int k) {
            return std::pair(std::int64_t(std::floor((bounds.min[k] - within_ - low_[k]) / cell_)),
                             std::int64_t(std::floor((bounds.max[k] + within_ - low_[k]) / cell_)));
        };
        const auto [x0, x1] = range(0);
        const auto [y0, y1] = range(1);
        const auto [z0, z1] = range(2);
        for (std::int64_t z = z0; z <= z1; ++z)
            for (std::int64_t y = y0; y <= y1; ++y)
                for (std::int64_t x = x0; x <= x1; ++x) cells_[(z * row + y) * row + x].push_back(std::uint32_t(i));
    }
}

std::int64_t NearSurface::cell_at(const Vec3& point) const {
    const auto along = [&](int k) { return std::int64_t(std::floor((point[k] - low_[k]) / cell_)); };
    return (along(2) * row + along(1)) * row + along(0);
}

bool NearSurface::holds(const Vec3& point) const {
    const auto cell = cells_.find(cell_at(point));
    if (cell == cells_.end()) return false;
    return std::any_of(cell->second.begin(), cell->second.end(), [&](std::uint32_t i) {
        const Triangle& t = triangles_[i];
        return distance_to_triangle(point, t[0], t[1], t[2]) <= within_;
    });
}

}  // namespace tumble
