// An image in memory.
#pragma once

#include "version.h"

#include <cstddef>
#include <cstdint>
#include <vector>

TUMBLE_BEGIN

/// RGBA, 8 bits per channel, sRGB, straight alpha (255: opaque), top row first, rows without padding.
struct Image {
    int width = 0, height = 0;         // pixels
    std::vector<std::uint8_t> pixels;  // width * height * 4

    /// The four bytes of a pixel; column and row count from 0, the row from the top. Both must be
    /// within the image.
    const std::uint8_t* at(int column, int row) const {
        return pixels.data() + 4 * (std::size_t(row) * std::size_t(width) + std::size_t(column));
    }
};

inline bool operator==(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.pixels == b.pixels;
}
inline bool operator!=(const Image& a, const Image& b) { return !(a == b); }

TUMBLE_END
