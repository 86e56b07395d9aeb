#include "core/image_mean.h"

#include "core/check.h"
#include "core/color.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr double white = 65535.0;  // scale of linear light: the darkest two sRGB values are still 20 apart

}  // namespace

ImageMean::ImageMean(bool transparent) : transparent_(transparent) {}

void ImageMean::make_tables() {
    srgb_.resize(std::size_t(white) + 1);
    for (std::size_t i = 0; i < linear_.size(); ++i)
        linear_[i] = static_cast<std::uint16_t>(std::lround(white * srgb_to_linear(double(i) / 255.0)));
    for (std::size_t i = 0; i < srgb_.size(); ++i)
        srgb_[i] = static_cast<std::uint8_t>(std::lround(255.0 * linear_to_srgb(double(i) / white)));
}

void ImageMean::add(const Image& image) {
    if (srgb_.empty()) make_tables();
    if (count_ == 0) {
        width_ = image.width;
        height_ = image.height;
        sums_.assign((transparent_ ? 4 : 3) * image.pixels.size() / 4, 0);
    }
    TUMBLE_CHECK_EQ(image.width, width_);
    TUMBLE_CHECK_EQ(image.height, height_);
    ++count_;
    const std::uint8_t* from = image.pixels.data();
    if (transparent_) {
        for (std::size_t i = 0; i < sums_.size(); i += 4, from += 4) {
            for (std::size_t c = 0; c < 3; ++c) sums_[i + c] += std::uint32_t(linear_[from[c]]) * from[3];
            sums_[i + 3] += from[3];
        }
        return;
    }
    for (std::size_t i = 0; i < sums_.size(); i += 3, from += 4)
        for (std::size_t c = 0; c < 3; ++c) sums_[i + c] += linear_[from[c]];
}

void ImageMean::take(Image& mean) {
    TUMBLE_CHECK_GT(count_, 0u);
    if (mean.width != width_ || mean.height != height_) mean = Image(width_, height_);
    std::uint8_t* to = mean.pixels.data();
    const std::uint32_t images = std::exchange(count_, 0);
    if (transparent_) {
        for (std::size_t i = 0; i < sums_.size(); i += 4, to += 4) {
            const std::uint32_t weight = sums_[i + 3];
            for (std::size_t c = 0; c < 3; ++c) to[c] = weight == 0 ? 0 : srgb_[(sums_[i + c] + weight / 2) / weight];
            to[3] = std::uint8_t((weight + images / 2) / images);
        }
        return;
    }
    for (std::size_t i = 0; i < sums_.size(); i += 3, to += 4) {
        for (std::size_t c = 0; c < 3; ++c) to[c] = srgb_[(sums_[i + c] + images / 2) / images];
        to[3] = 255;
    }
}

}  // namespace tumble
