// What can be seen at all. With several samples a pixel llvmpipe shades everything that is drawn, hidden or not, so
// what certainly lies behind a box is left out beforehand: the screen is divided into small cells, each knows how near
// the nearest box is that covers it wholly, and a body all of whose cells are covered by nearer boxes is not drawn.
// Only the certain is left out: the picture is the same to the byte.
#pragma once

#include "render/scene/render_scene.h"
#include "render/camera/camera.h"
#include "sim/snapshot/snapshot.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class CoarseDepthBuffer {
public:
    static constexpr int cell = 8;  // pixels: smaller ones hide little more and cost more to fill

    explicit CoarseDepthBuffer(const Camera& view);

    int columns() const { return columns_; }
    int rows() const { return rows_; }

    /// Along the view axis, m: everything further away is hidden in this cell.
    double depth(int column, int row) const { return depths_[std::size_t(row * columns_ + column)]; }

    /// The eight corners of a box, relative to the eye: corner i is on the high side of axis k when bit k of i is set.
    using Corners = std::array<Vec3, 8>;
    void add(const Corners& corners);

    /// Is all that lies within the convex hull of the points hidden?
    bool hides(std::span<const Vec3> points) const;

private:
    const Camera* view_;
    int columns_, rows_;
    std::vector<double> depths_;
};

struct Visibility {
    CoarseDepthBuffer cover;
    std::vector<bool> bodies;  // in scene order: may any part of it be in the picture? (false for planes)
    std::vector<std::uint8_t>
        faces;  // of boxes: bit 2 k for the face on the low side of axis k, 2 k + 1 for the high one
};

/// `one_sample`: the picture is drawn with one sample a pixel; then many small boxes are looked at pixel by pixel
/// (pixel_cover.h).
Visibility find_visible(const RenderScene& looks, const Snapshot& snapshot, const Camera& view, bool one_sample = false);

/// As if nothing hid anything.
Visibility everything_visible(const RenderScene& looks, const Camera& view);

}  // namespace tumble
