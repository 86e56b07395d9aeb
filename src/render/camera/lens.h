// Points of a lens. In an image through each, points in focus are at the same pixel and all else is displaced; the mean
// of these images is that of a wide lens.
#pragma once

#include "scene/description/description.h"

#include <vector>

namespace tumble {

/// One of the moments of a frame that is blurred by motion: they share the points of the lens.
struct FrameMoment {
    int index = 0, count = 1;
    bool operator==(const FrameMoment&) const = default;
};

/// The points that a moment sees through, in radii from the middle of the lens: right, up. All moments together have
/// at least `samples` points, spread evenly over the lens, and each as many.
std::vector<Eigen::Vector2d> lens_points(int samples, const FrameMoment& moment);

/// True if the camera or one of its shots has a lens.
bool has_lens(const CameraDescription& camera);

}  // namespace tumble
