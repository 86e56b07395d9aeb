// Culling of many small boxes: a depth at each pixel center, where frames with one sample per pixel are sampled. Boxes
// are added nearest first. A face that covers no pixel center in front of the stored depths need not be drawn. With
// several samples per pixel this is invalid.
#pragma once

#include "render/camera/camera.h"
#include "render/camera/convex_hull_2d.h"
#include "render/culling/occlusion_culling.h"

#include <array>
#include <vector>

namespace tumble {

class SoftwareDepthBuffer {
public:
    /// `boxes`: additional occluders, by cell. Must outlive it.
    SoftwareDepthBuffer(const Camera& view, const CoarseDepthBuffer& boxes);

    /// A corner on the screen: pixels, and the reciprocal of the depth along the axis, 1/m.
    struct Corner {
        ScreenPoint at;
        double inverse_depth;
    };

    /// Adds a convex face and the pixels that it certainly covers. Returns true if it may have been visible before
    /// that.
    bool add(const std::array<Corner, 4>& face);

    /// True if a rectangle of the screen is hidden for bodies at `depth`, m, or farther.
    bool hides(double x0, double y0, double x1, double y1, double depth) const;

private:
    const CoarseDepthBuffer* boxes_;
    int width_, height_;
    std::vector<float> inverse_depths_;  // the nearest in each pixel; 0: infinitely far
};

}  // namespace tumble
