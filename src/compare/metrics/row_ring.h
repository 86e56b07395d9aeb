// The last rows of a plane, for filters along columns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tumble {

/// Rows y - radius to y + radius of a plane, where y goes down.
class RowRing {
public:
    RowRing(int width, int radius) : width_(std::size_t(width)), rows_(2 * radius + 1) {
        values_.resize(width_ * std::size_t(rows_));
    }

    float* row(int y) { return values_.data() + width_ * std::size_t(y % rows_); }

    /// The rows around y, for filter_columns(). Rows outside [top, bottom) are the nearest inside.
    const std::vector<const float*>& around(int y, int top, int bottom) {
        around_.clear();
        for (int k = -(rows_ / 2); k <= rows_ / 2; ++k) around_.push_back(row(std::clamp(y + k, top, bottom - 1)));
        return around_;
    }

private:
    std::size_t width_;
    int rows_;
    std::vector<float> values_;
    std::vector<const float*> around_;
};

}  // namespace tumble
