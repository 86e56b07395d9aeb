// An image in memory: the result of the renderer and the input of the outputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tumble {

struct ImageSize {
    int width = 0, height = 0;  // pixels
    friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// RGBA, 8 bits per channel, sRGB encoded, top row first, rows without padding.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels;  // width * height * 4

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h) * 4) {}

    std::uint8_t* at(int x, int y) {
        return pixels.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
    }
    const std::uint8_t* at(int x, int y) const {
        return pixels.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
    }
    friend bool operator==(const Image&, const Image&) = default;
};

// A rectangle of pixels.

/// Pixels, from the top left corner of the image.
struct Rectangle {
    int x = 0, y = 0;
    int width = 0, height = 0;
    friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

// The depth of a frame's surfaces in memory, for shapes that are drawn over the image.

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
