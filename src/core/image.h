// An image in memory: the result of the renderer and the input of the outputs.
#pragma once

#include <cstddef>
#include <cstdint>
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

}  // namespace tumble
