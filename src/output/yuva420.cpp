#include "output/yuva420.h"

#include "core/check.h"
#include "output/yuv420.h"

#include <algorithm>

namespace tumble {
namespace {

constexpr int block = 16;  // pixels: the codec's blocks are of this size or a multiple

Rectangle enlarged_to_blocks(const Rectangle& region, int width, int height) {
    const int left = std::max(region.x, 0) / block * block, top = std::max(region.y, 0) / block * block;
    const int right = std::min((region.x + region.width + block - 1) / block * block, width);
    const int bottom = std::min((region.y + region.height + block - 1) / block * block, height);
    return {left, top, right - left, bottom - top};
}

/// Copies a block; its pixels without coverage get the mean color of the others.
void fill_block(const Image& image, const Rectangle& r, Image& filled) {
    int weight = 0, sums[3] = {};
    for (int y = r.y; y < r.y + r.height; ++y)
        for (int x = r.x; x < r.x + r.width; ++x) {
            const std::uint8_t* const from = image.at(x, y);
            weight += from[3];
            for (int c = 0; c < 3; ++c) sums[c] += from[3] * from[c];
        }
    std::uint8_t mean[3] = {};
    for (int c = 0; c < 3 && weight > 0; ++c) mean[c] = static_cast<std::uint8_t>((sums[c] + weight / 2) / weight);
    for (int y = r.y; y < r.y + r.height; ++y)
        for (int x = r.x; x < r.x + r.width; ++x) {
            const std::uint8_t* const from = image.at(x, y);
            std::copy_n(from[3] == 0 ? mean : from, 3, filled.at(x, y));
        }
}

}  // namespace

std::size_t yuva420_bytes(int width, int height) {
    return yuv420_bytes(width, height) + std::size_t(width) * std::size_t(height);
}

void convert_to_yuva420(const Image& image, const Rectangle& region, Image& filled, std::span<std::uint8_t> planes) {
    TUMBLE_CHECK_EQ(planes.size(), yuva420_bytes(image.width, image.height));
    if (filled.width != image.width || filled.height != image.height) filled = Image(image.width, image.height);
    const Rectangle blocks = enlarged_to_blocks(region, image.width, image.height);
    const int right = blocks.x + blocks.width, bottom = blocks.y + blocks.height;
    for (int y = blocks.y; y < bottom; y += block)
        for (int x = blocks.x; x < right; x += block)
            fill_block(image, {x, y, std::min(block, right - x), std::min(block, bottom - y)}, filled);
    const std::size_t color = yuv420_bytes(image.width, image.height);
    convert_to_yuv420(filled, blocks, planes.first(color));
    for (int y = blocks.y; y < bottom; ++y) {
        std::uint8_t* const to = planes.data() + color + std::size_t(y) * std::size_t(image.width);
        for (int x = blocks.x; x < right; ++x) to[x] = image.at(x, y)[3];
    }
}

}  // namespace tumble
