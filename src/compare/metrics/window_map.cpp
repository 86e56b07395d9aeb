#include "compare/metrics/window_map.h"

#include "compare/metrics/background.h"
#include "core/check.h"

#include <algorithm>
#include <cstdlib>

namespace tumble {
namespace {

constexpr int side = 8, step = side / 2;  // pixels of a window, and between windows

int largest_difference(const std::uint8_t* a, const std::uint8_t* b) {
    int most = std::abs(int(a[3]) - int(b[3]));
    for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(int(seen_on_background(a, c, black_background)) -
                                       int(seen_on_background(b, c, black_background))));
    return most;
}

/// Starts of windows along one side.
std::vector<int> starts_along(int size) {
    std::vector<int> result;
    for (int i = 0; i + side < size; i += step) result.push_back(i);
    result.push_back(std::max(0, size - side));
    return result;
}

}  // namespace

MetricMap window_map(const Image& a, const Image& b) {
    TUMBLE_CHECK_EQ(a.width, b.width);
    TUMBLE_CHECK_EQ(a.height, b.height);
    MetricMap map(a.width, a.height);
    if (a.width == 0 || a.height == 0) return map;
    std::vector<int> sums(std::size_t(a.width));  // of the columns of a row of windows
    for (const int top : starts_along(a.height)) {
        const int bottom = std::min(a.height, top + side);
        std::fill(sums.begin(), sums.end(), 0);
        for (int y = top; y < bottom; ++y)
            for (int x = 0; x < a.width; ++x) sums[std::size_t(x)] += largest_difference(a.at(x, y), b.at(x, y));
        for (const int left : starts_along(a.width)) {
            const int right = std::min(a.width, left + side);
            int sum = 0;
            for (int x = left; x < right; ++x) sum += sums[std::size_t(x)];
            if (sum == 0) continue;
            const float mean = float(sum) / float(side * side);
            for (int y = top; y < bottom; ++y) {
                float* const row = map.row(y);
                for (int x = left; x < right; ++x) row[x] = std::max(row[x], mean);
            }
        }
    }
    return map;
}

}  // namespace tumble
