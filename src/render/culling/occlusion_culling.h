// Occlusion culling. With several samples per pixel llvmpipe shades all drawn pixels, hidden or not, so bodies that are
// certainly behind a box are not drawn. The screen is divided into small cells. Each cell stores the depth of the
// nearest box that covers it completely; a body is hidden if all of its cells are covered by nearer boxes. The test is
// conservative: the frame is the same to the byte.
#pragma once

#include "render/camera/camera.h"
#include "render/frame/frame_context.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class CoarseDepthBuffer {
public:
    static constexpr int cell = 8;  // pixels: smaller cells hide little more and cost more

    explicit CoarseDepthBuffer(const Camera& view);

    int columns() const { return columns_; }
    int rows() const { return rows_; }

    /// Along the view axis, m: farther bodies are hidden in this cell.
    double depth(int column, int row) const { return depths_[std::size_t(row * columns_ + column)]; }

    /// The eight corners of a box, m, relative to the eye: corner i is on the high side of axis k if bit k of i is set.
    using Corners = std::array<Vec3, 8>;
    void add(const Corners& corners);

    /// True if the convex hull of the points is hidden.
    bool hides(std::span<const Vec3> points) const;

private:
    const Camera* view_;
    int columns_, rows_;
    std::vector<double> depths_;
};

struct Visibility {
    CoarseDepthBuffer cover;
    std::vector<bool> bodies;  // in scene order: true if a part may be visible (false for planes)
    std::vector<std::uint8_t>
        faces;  // of boxes: bit 2 k for the face on the low side of axis k, 2 k + 1 for the high side
};

/// With one sample per pixel, many small boxes are culled per pixel (software_depth_buffer.h).
Visibility find_visible(const FrameContext& frame);

/// Without culling.
Visibility everything_visible(const FrameContext& frame);

}  // namespace tumble
