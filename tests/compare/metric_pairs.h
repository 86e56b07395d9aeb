// Pairs of pictures in closed form, for metrics: another program can make the same ones.
#pragma once

#include "core/image.h"
#include "support/pictures.h"

#include <utility>

namespace tumble {

using MetricPair = std::pair<Image, Image>;

/// Colors that change from pixel to pixel like noise.
inline int noise_level(int x, int y, int channel) {
    return (x * 73 + y * 151 + channel * 199 + (x * y) % 101 * 37 + (x * x + 3 * y * y) % 251 * 11) % 256;
}

/// The pixel at (x, y) is color(x, y, channel).
template <typename Color>
Image painted(int width, int height, const Color& color) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) set(image, x, y, {color(x, y, 0), color(x, y, 1), color(x, y, 2)});
    return image;
}

inline int ramp_level(int x, int y, int channel) {
    return (channel == 0 ? 4 * x : channel == 1 ? 5 * y : 2 * x + 3 * y) % 256;
}

/// A red box on colored ramps, 64 x 48.
inline MetricPair box_pair() {
    const Image a = painted(64, 48, ramp_level);
    Image b = a;
    fill(b, 20, 10, 20, 20, {200, 60, 20});
    return {a, b};
}

/// A box that moves by one pixel, 64 x 48.
inline MetricPair moved_pair() {
    Image a = plain(64, 48, {40, 40, 40}), b = a;
    fill(a, 16, 12, 12, 12, {220, 180, 60});
    fill(b, 17, 12, 12, 12, {220, 180, 60});
    return {a, b};
}

/// Noise, and the same with an eighth of its neighbor, 160 x 90.
inline MetricPair noise_pair() {
    return {painted(160, 90, noise_level), painted(160, 90, [](int x, int y, int c) {
                return (noise_level(x, y, c) * 7 + noise_level(x + 1, y, c) + 4) / 8;
            })};
}

/// A checkerboard and the same with less contrast, 160 x 90.
inline MetricPair checker_pair() {
    return {painted(160, 90, [](int x, int y, int) { return (x / 8 + y / 8) % 2 * 255; }),
            painted(160, 90, [](int x, int y, int) { return (x / 8 + y / 8) % 2 * 255 * 15 / 16 + 8; })};
}

}  // namespace tumble
