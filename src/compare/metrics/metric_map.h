// A value of a metric at each pixel.
#pragma once

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

}  // namespace tumble
