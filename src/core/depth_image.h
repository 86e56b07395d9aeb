// The depth of a frame's surfaces in memory, for shapes that are drawn over the image.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace tumble {

/// Distance along the view axis of the surface at each pixel's center, m; infinity for the sky. Top row first.
struct DepthImage {
    int width = 0, height = 0;
    std::vector<float> depths;

    DepthImage() = default;
    DepthImage(int w, int h)
        : width(w), height(h), depths(std::size_t(w) * std::size_t(h), std::numeric_limits<float>::infinity()) {}

    float* at(int x, int y) { return depths.data() + std::size_t(y) * std::size_t(width) + std::size_t(x); }
    const float* at(int x, int y) const { return depths.data() + std::size_t(y) * std::size_t(width) + std::size_t(x); }
};

}  // namespace tumble
