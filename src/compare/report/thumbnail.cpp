#include "compare/report/thumbnail.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tumble {
namespace {

/// Pixels [first, last) of the image, for a pixel of the small one.
struct PixelSpan {
    int first, last;
};

PixelSpan covered_pixels(int i, int small, int large) {
    const auto at = [&](int k) { return static_cast<int>(std::int64_t(k) * large / small); };
    return {at(i), std::max(at(i + 1), at(i) + 1)};
}

}  // namespace

Image thumbnail(const Image& image, int width, int height) {
    if (image.width <= width && image.height <= height) return image;
    const std::int64_t w = image.width, h = image.height;
    const bool wide = w * height > h * width;
    const int small_w = wide ? width : std::max(1, static_cast<int>(w * height / h));
    const int small_h = wide ? std::max(1, static_cast<int>(h * width / w)) : height;
    Image small(small_w, small_h);
    for (int y = 0; y < small_h; ++y)
        for (int x = 0; x < small_w; ++x) {
            const PixelSpan columns = covered_pixels(x, small_w, image.width),
                            rows = covered_pixels(y, small_h, image.height);
            std::array<std::int64_t, 4> sums{};
            for (int row = rows.first; row < rows.last; ++row)
                for (int column = columns.first; column < columns.last; ++column)
                    for (std::size_t c = 0; c < 4; ++c) sums[c] += image.at(column, row)[c];
            const std::int64_t count =
                std::int64_t(rows.last - rows.first) * std::int64_t(columns.last - columns.first);
            for (std::size_t c = 0; c < 4; ++c)
                small.at(x, y)[c] = static_cast<std::uint8_t>((sums[c] + count / 2) / count);
        }
    return small;
}

}  // namespace tumble
