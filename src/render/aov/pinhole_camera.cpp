#include "render/aov/pinhole_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

PinholeCamera::PinholeCamera(const Camera& view)
    : width(view.width()),
      height(view.height()),
      focal(1.0 / view.pixel_size()),
      center_x(0.5 * (view.width() - 1)),
      center_y(0.5 * (view.height() - 1)),
      eye(view.eye()) {
    axes << view.right(), -view.up(), view.forward();
}

namespace {

// Depth over the distance from the axis below which the projection of a point is too uncertain.
constexpr double steepest = 1e-6;

/// Clamps a screen coordinate to one pixel outside the image and rounds it.
int to_pixel(double place, int size) { return int(std::clamp(place, -1.0, double(size))); }

}  // namespace

PixelBounds pixel_bounds(std::span<const Vec3> points, const PinholeCamera& camera) {
    const double infinite = std::numeric_limits<double>::infinity();
    double left = infinite, right = -infinite, up = infinite, down = -infinite;
    bool before = false, behind = false;
    for (const Vec3& p : points) {
        if (p.z() > 0.0) before = true;
        if (!(p.z() > steepest * std::max(std::abs(p.x()), std::abs(p.y())))) {
            behind = true;
            continue;
        }
        const double column = camera.focal * p.x() / p.z() + camera.center_x;
        const double row = camera.focal * p.y() / p.z() + camera.center_y;
        left = std::min(left, column);
        right = std::max(right, column);
        up = std::min(up, row);
        down = std::max(down, row);
    }
    if (!before) return {};
    if (behind) return {0, camera.width - 1, 0, camera.height - 1};
    PixelBounds bounds;
    bounds.first = std::max(to_pixel(std::floor(left), camera.width), 0);
    bounds.last = std::min(to_pixel(std::ceil(right), camera.width), camera.width - 1);
    bounds.top = std::max(to_pixel(std::floor(up), camera.height), 0);
    bounds.bottom = std::min(to_pixel(std::ceil(down), camera.height), camera.height - 1);
    return bounds;
}

}  // namespace tumble
