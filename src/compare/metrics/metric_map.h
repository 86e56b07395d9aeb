// A metric's value at each pixel, as a picture too; and where two images differ at all.
#pragma once

#include "core/image.h"

#include <cstddef>
#include <vector>

namespace tumble {

/// Rows from the top, without padding.
struct MetricMap {
    int width = 0, height = 0;
    std::vector<float> values;  // width * height

    MetricMap() = default;
    MetricMap(int w, int h, float value = 0.0f) : width(w), height(h), values(std::size_t(w) * std::size_t(h), value) {}

    float* row(int y) { return values.data() + std::size_t(y) * std::size_t(width); }
    const float* row(int y) const { return values.data() + std::size_t(y) * std::size_t(width); }
    float at(int x, int y) const { return row(y)[x]; }
};

/// Values from 0 (black) over purple and orange to `hot` (light yellow); values beyond have the color of the nearer
/// end.
Image heat_map(const MetricMap& map, float hot = 1.0f);

/// Metrics of a neighborhood need no work beside it: the smallest rectangle with all pixels that differ in any channel;
/// empty if the images are equal. Precondition: the sizes are equal.
Rectangle changed_region(const Image& a, const Image& b);

/// The rectangle with `margin` more pixels at each side, within the image. An empty one stays empty.
Rectangle with_margin(const Rectangle& region, int margin, const Image& image);

}  // namespace tumble
