// What can be seen of many small boxes: a depth for each pixel's middle, where pictures of one sample a pixel look and
// nowhere else. Boxes go in nearest first; a face that no pixel's middle shows need not be drawn: it lies between the
// middles, or behind what came before. With several samples a pixel this does not hold.
#pragma once

#include "render/camera/camera.h"
#include "render/camera/convex_hull_2d.h"
#include "render/culling/occlusion_culling.h"

#include <array>
#include <vector>

namespace tumble {

class SoftwareDepthBuffer {
public:
    /// `boxes`: what hides besides, cell by cell. Must outlive it.
    SoftwareDepthBuffer(const Camera& view, const CoarseDepthBuffer& boxes);

    /// A corner on the screen: pixels, and one over the depth along the axis, 1/m.
    struct Corner {
        ScreenPoint at;
        double inverse_depth;
    };

    /// Covers what a convex face certainly covers. Could any of it be seen before that?
    bool add(const std::array<Corner, 4>& face);

    /// Is all of a rectangle of the screen hidden, for what is no nearer than `depth`, m?
    bool hides(double x0, double y0, double x1, double y1, double depth) const;

private:
    const CoarseDepthBuffer* boxes_;
    int width_, height_;
    std::vector<float> inverse_depths_;   // the nearest in each pixel; 0: nothing
};

}  // namespace tumble
