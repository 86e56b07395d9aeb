// Frames as PNG files: 8-bit RGB, tagged sRGB (a rendered frame is opaque, so its fourth channel is left out).
#pragma once

#include "core/image.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace tumble {

/// The bytes of the PNG file of `image`. `bytes` is replaced; hand the same vector in again to save its allocation.
/// Throws RunError when libpng refuses the picture (an empty one, or one larger than the format allows).
void encode_png(const Image& image, std::vector<std::byte>& bytes);

/// Writes PNG files one after another, in one allocation.
class PngFile {
public:
    /// Writes the file whole or not at all (see TemporaryFile). Throws RunError naming the file.
    void write(const std::filesystem::path& path, const Image& image);

private:
    std::vector<std::byte> bytes_;
};

/// The same for a single file.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace tumble
