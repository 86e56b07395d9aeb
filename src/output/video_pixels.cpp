#include "output/video_pixels.h"

#include "core/check.h"
#include "output/yuv420.h"

#include <algorithm>
#include <cstring>

namespace tumble {

VideoPixels::VideoPixels(PixelFormat form, int width, int height)
    : format_(form), width_(width), height_(height), bytes_(frame_bytes(form, width, height)) {
    if (is_subsampled(form) && (width % 2 != 0 || height % 2 != 0))
        padded_ = Image(width + width % 2, height + height % 2);
}

void VideoPixels::update(const Image& image, std::span<const Rectangle> changed) {
    TUMBLE_CHECK_EQ(image.width, width_);
    TUMBLE_CHECK_EQ(image.height, height_);
    if (changed.empty()) return;
    if (format_ == PixelFormat::rgba) {
        for (const Rectangle& r : changed)
            for (int y = r.y; y < r.y + r.height; ++y)
                std::memcpy(bytes_.data() + (image.at(r.x, y) - image.pixels.data()), image.at(r.x, y),
                            4 * std::size_t(r.width));
    } else if (!padded_.pixels.empty()) {
        convert(padded(image), {0, 0, padded_.width, padded_.height});
    } else {
        for (const Rectangle& r : changed) convert(image, r);
    }
}

void VideoPixels::convert(const Image& image, const Rectangle& region) {
    if (format_ == PixelFormat::yuva420)
        convert_to_yuva420(image, region, filled_, bytes_);
    else
        convert_to_yuv420(image, region, bytes_);
}

const Image& VideoPixels::padded(const Image& image) {
    const std::size_t row = 4 * std::size_t(width_);
    for (int y = 0; y < padded_.height; ++y) {
        std::uint8_t* to = padded_.at(0, y);
        std::memcpy(to, image.at(0, std::min(y, height_ - 1)), row);
        if (padded_.width > width_) std::memcpy(to + row, to + row - 4, 4);
    }
    return padded_;
}

}  // namespace tumble
