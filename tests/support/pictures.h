// Synthetic pictures for tests.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>

namespace tumble {

using Pixel = std::array<int, 3>;

inline void set(Image& image, int x, int y, Pixel color) {
    for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(color[std::size_t(c)]);
    image.at(x, y)[3] = 255;
}

inline void fill(Image& image, int left, int top, int width, int height, Pixel color) {
    for (int y = top; y < top + height; ++y)
        for (int x = left; x < left + width; ++x) set(image, x, y, color);
}

inline Image plain(int width, int height, Pixel color) {
    Image image(width, height);
    fill(image, 0, 0, width, height, color);
    return image;
}

/// All rows, columns and channels differ.
inline Image colorful(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) set(image, x, y, {(7 * x + y) % 256, (3 * y + 11) % 256, (x * y + 5) % 256});
    return image;
}

/// A sky over ground, with a gradient of brightness in each: a frame without bodies.
inline Image landscape(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            set(image, x, y,
                y < height / 3 ? Pixel{150 + y / 4, 180 + y / 5, 215} : Pixel{120 + x / 8, 118 + x / 8, 110});
    return image;
}

}  // namespace tumble
