#include "compare/metrics/window_map.h"

#include "compare/metrics/pixel_windows.h"
#include "core/check.h"

#include <algorithm>

namespace tumble {

MetricMap window_map(const Image& a, const Image& b) {
    TUMBLE_CHECK_EQ(a.width, b.width);
    TUMBLE_CHECK_EQ(a.height, b.height);
    MetricMap map(a.width, a.height);
    if (a.width == 0 || a.height == 0) return map;
    std::vector<int> sums(std::size_t(a.width));  // of the columns of a row of windows
    for (const int top : window_starts(a.height)) {
        const int bottom = std::min(a.height, top + window_side);
        std::fill(sums.begin(), sums.end(), 0);
        for (int y = top; y < bottom; ++y)
            for (int x = 0; x < a.width; ++x) sums[std::size_t(x)] += pixel_difference(a.at(x, y), b.at(x, y));
        for (const int left : window_starts(a.width)) {
            const int right = std::min(a.width, left + window_side);
            int sum = 0;
            for (int x = left; x < right; ++x) sum += sums[std::size_t(x)];
            if (sum == 0) continue;
            const float mean = float(sum) / float(window_side * window_side);
            for (int y = top; y < bottom; ++y) {
                float* const row = map.row(y);
                for (int x = left; x < right; ++x) row[x] = std::max(row[x], mean);
            }
        }
    }
    return map;
}

}  // namespace tumble
