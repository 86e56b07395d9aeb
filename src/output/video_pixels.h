// One frame as the bytes that ffmpeg is fed with, kept up to date from the pictures: only what changed is converted.
#pragma once

#include "core/image.h"
#include "core/rectangle.h"
#include "output/video_format.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

class VideoPixels {
public:
    /// Of pictures of this size; for 4:2:0 an odd last column or row is there twice.
    VideoPixels(PixelForm form, int width, int height);

    /// Takes over the parts of the picture that may differ from the one before; at first that must be all of it.
    void update(const Image& image, std::span<const Rectangle> changed);

    std::span<const std::byte> bytes() const { return std::as_bytes(std::span(bytes_)); }

private:
    const Image& padded(const Image& image);

    PixelForm form_;
    int width_, height_;
    Image padded_;                       // empty where the size is even
    std::vector<std::uint8_t> bytes_;
};

}  // namespace tumble
