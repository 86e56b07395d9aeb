// Any PNG file as one of our pictures.
#pragma once

#include "core/image.h"

#include <filesystem>

namespace tumble {

struct PictureSize {
    int width = 0, height = 0;   // pixels
    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// The most pixels a picture may have: 16384 x 16384, 1 GiB in memory. A small hostile file may claim far more.
inline constexpr std::int64_t max_picture_pixels = std::int64_t(1) << 28;

/// Every colour type, depth and interlacing becomes 8-bit sRGB with alpha (255 where the file has none).
/// Throws InputError naming the file where it is missing, no PNG, broken, cut short or too large.
Image read_png(const std::filesystem::path& path);

/// The size alone, from the file's head. Throws like read_png, but does not look at the pixels.
PictureSize read_png_size(const std::filesystem::path& path);

}  // namespace tumble
