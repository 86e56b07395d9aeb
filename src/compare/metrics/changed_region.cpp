#include "compare/metrics/changed_region.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace tumble {

Rectangle changed_region(const Image& a, const Image& b) {
    int left = a.width, right = 0, top = a.height, bottom = 0;
    const std::size_t bytes = 4 * std::size_t(a.width);
    const auto differs = [&](int x, int y) { return std::memcmp(a.at(x, y), b.at(x, y), 4) != 0; };
    for (int y = 0; y < a.height; ++y) {
        if (std::memcmp(a.at(0, y), b.at(0, y), bytes) == 0) continue;
        top = std::min(top, y);
        bottom = y + 1;
        int first = 0, last = a.width - 1;
        while (first < left && !differs(first, y)) ++first;
        while (last >= right && !differs(last, y)) --last;
        left = std::min(left, first);
        right = std::max(right, last + 1);
    }
    if (bottom == 0) return {};
    return {left, top, right - left, bottom - top};
}

Rectangle with_margin(const Rectangle& region, int margin, const Image& image) {
    if (region.width == 0 || region.height == 0) return {};
    const int left = std::max(0, region.x - margin), top = std::max(0, region.y - margin);
    const int right = std::min(image.width, region.x + region.width + margin);
    const int bottom = std::min(image.height, region.y + region.height + margin);
    return {left, top, right - left, bottom - top};
}

}  // namespace tumble
