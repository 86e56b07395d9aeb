// Our pictures as PNG files: 8-bit RGB, sRGB. libpng writes the file; its pixels are compressed by libdeflate and given
// to it as a ready chunk, which takes two thirds of zlib's time (bench/README.md).
#pragma once

#include "core/image.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;

namespace tumble {

/// Makes PNG files in memory, one after the other; not for several threads at once.
class PngEncoder {
public:
    PngEncoder();
    ~PngEncoder();

    /// The whole file, valid until the next call. The same picture gives the same bytes. Alpha is left out. Throws
    /// RunError where the picture is empty or memory runs out.
    std::span<const std::byte> encode(const Image& image);

private:
    void pack_rows(const Image& image);

    struct FreeCompressor {
        void operator()(libdeflate_compressor* compressor) const;
    };
    std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor_;
    std::vector<std::uint8_t> rows_, compressed_;
    std::vector<std::byte> file_;
};

/// The most bytes that a PNG of this size takes.
std::size_t png_bytes_bound(int width, int height);

/// Writes through a temporary file. Throws RunError naming the path.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace tumble
