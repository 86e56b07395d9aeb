// The pixels whose rays may meet a shape.
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

/// Of the convex hull of some points in the camera's frame: never too few pixels.
PixelBounds pixel_bounds(std::span<const Vec3> points, const PinholeCamera& camera);

}  // namespace tumble
