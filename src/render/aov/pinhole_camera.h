// The camera in the convention of computer vision and OpenCV: x to the right, y down, z forward, in m from the eye, and
//   column = focal x / z + center_x,   row = focal y / z + center_y
// with integers at pixel centers and (0, 0) at the top left pixel.
#pragma once

#include "core/vector.h"
#include "render/camera/camera.h"

#include <span>

namespace tumble {

struct PinholeCamera {
    explicit PinholeCamera(const Camera& view);

    int width, height;          // pixels
    double focal;               // pixels, for both axes, because pixels are square
    double center_x, center_y;  // pixels
    Mat3 axes;                  // columns: the camera's x, y and z in world axes
    Vec3 eye;                   // m, world frame

    /// The ray through a pixel center is (x, y, 1).
    double ray_x(int column) const { return (column - center_x) / focal; }
    double ray_y(int row) const { return (row - center_y) / focal; }

    Vec3 from_world(const Vec3& point) const { return axes.transpose() * (point - eye); }

    friend bool operator==(const PinholeCamera&, const PinholeCamera&) = default;
};

/// Columns first .. last and rows top .. bottom, both included; empty where first > last or top > bottom.
struct PixelBounds {
    int first = 0, last = -1, top = 0, bottom = -1;
    bool empty() const { return first > last || top > bottom; }
};

/// Conservative bounds of the convex hull of points in the camera frame.
PixelBounds pixel_bounds(std::span<const Vec3> points, const PinholeCamera& camera);

}  // namespace tumble
