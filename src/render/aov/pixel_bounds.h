// Bounds of the pixels whose rays may hit a shape.
#pragma once

#include "core/vector.h"
#include "render/aov/pinhole_camera.h"

#include <span>

namespace tumble {

/// Columns first .. last and rows top .. bottom, both included; empty where first > last or top > bottom.
struct PixelBounds {
    int first = 0, last = -1, top = 0, bottom = -1;
    bool empty() const { return first > last || top > bottom; }
};

/// Conservative bounds of the convex hull of points in the camera frame.
PixelBounds pixel_bounds(std::span<const Vec3> points, const PinholeCamera& camera);

}  // namespace tumble
