// One frame as input bytes of ffmpeg, updated from the images: only changed regions are converted.
#pragma once

#include "core/image.h"
#include "output/video_format.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class VideoPixels {
public:
    /// `width`, `height`: of the images; for 4:2:0 an odd last column or row is duplicated.
    VideoPixels(PixelFormat form, int width, int height);

    /// Converts the regions of the image that may differ from the previous one; in the first call that must be all of
    /// it.
    void update(const Image& image, std::span<const Rectangle> changed);

    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(bytes_)); }

private:
    const Image& padded(const Image& image);
    void convert(const Image& image, const Rectangle& region);

    PixelFormat format_;
    int width_, height_;
    Image padded_;  // empty if the size is even
    Image filled_;  // of yuv420.h
    std::vector<std::uint8_t> bytes_;
};

}  // namespace tumble
