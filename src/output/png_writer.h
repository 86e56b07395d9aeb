// Our pictures as PNG files: 8-bit RGB, sRGB. libpng writes the head; the pixels are compressed by ISA-L (igzip) in bands
// of rows that do not look at each other, so that of a frame that is like the one before only the changed bands are
// compressed again. The bytes are those of compressing all of them.
#pragma once

#include "core/image.h"
#include "core/rectangle.h"
#include "output/deflater.h"
#include "output/temporary_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace tumble {

/// Makes PNG files in memory, one after the other; not for several threads at once.
class PngEncoder {
public:
    /// The whole file, valid until the next call. `changed` are the parts that may differ from the picture before; a
    /// first picture, and one of another size, is taken as a whole. Alpha is left out. Throws RunError where the
    /// picture is empty or memory runs out.
    std::span<const std::byte> encode(const Image& image, std::span<const Rectangle> changed);
    std::span<const std::byte> encode(const Image& image);

private:
    friend class PngRowWriter;
    struct Band {
        std::vector<std::uint8_t> compressed;
        std::uint32_t checksum = 0;   // Adler-32 of its rows
    };
    void compress(const Image& image, int first_row, Band& band);
    void make_head();

    Deflater deflater_;
    int width_ = 0, height_ = 0;      // of the picture before
    std::vector<Band> bands_;
    std::vector<std::uint8_t> rows_;  // of one band, as they are compressed
    std::vector<std::byte> head_, file_;
};

/// The most bytes that a PNG of this size takes.
std::size_t png_bytes_bound(int width, int height);

/// Writes a PNG file of a picture that comes row by row, and keeps only one band of it.
class PngRowWriter {
public:
    /// Throws RunError naming the path.
    PngRowWriter(const std::filesystem::path& path, int width, int height);

    /// Four bytes a pixel; as many times as there are rows.
    void add_row(std::span<const std::uint8_t> row);

    /// The file has its name.
    void finish();

private:
    void write_band();

    TemporaryFile file_;
    PngEncoder encoder_;
    Image band_;                     // the rows on their way
    int height_;
    int rows_ = 0;                   // of the picture, that have come
    std::uint32_t checksum_ = 1;     // Adler-32 of those written
    PngEncoder::Band compressed_;
    std::vector<std::byte> chunk_;
};

/// Writes through a temporary file. Throws RunError naming the path.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace tumble
