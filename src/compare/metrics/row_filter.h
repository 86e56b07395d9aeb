// Convolution with filters of one dimension, symmetric or antisymmetric about the middle. Filters of two dimensions are
// products of them: one along rows, one along columns. All operations are in a fixed order, so vector instructions of
// any width give the same bits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace tumble {

enum class FilterKind {
    symmetric,
    antisymmetric,  // the weight of the middle is 0
    zero_sum,       // symmetric, and all weights sum to 0
};

/// Weights of the middle and of the offsets 1 to radius; the weight of offset -k is that of k, or its negative. Filters
/// of the last two kinds give exactly 0 where all values are equal.
struct RowFilter {
    std::vector<float> weights;  // radius + 1
    FilterKind kind = FilterKind::symmetric;

    int radius() const { return static_cast<int>(weights.size()) - 1; }
};

/// The filter along a row: `width` values. Precondition: row[-radius] to row[width - 1 + radius] exist.
void filter_row(const float* row, int width, const RowFilter& filter, float* to);

/// The filter along columns: rows[rows.size() / 2] is the middle, and the next one is the row below. At least
/// 2 * radius + 1 rows, each of `width` values.
void filter_columns(std::span<const float* const> rows, int width, const RowFilter& filter, float* to);

// The last rows of a plane, for filters along columns.

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
