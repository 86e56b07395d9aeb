// Images as PNG files: 8-bit RGB or RGBA, sRGB. libpng writes the header; the pixels are compressed by ISA-L (igzip) in
// independent bands of rows, so that only the changed bands of a frame are compressed again. The bytes equal those of
// compressing all bands.
#pragma once

#include "core/image.h"
#include "output/deflater.h"
#include "output/temporary_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tumble {

enum class PngAlpha { dropped, kept };

/// Keyword of the tEXt chunk of frames, which names the scene, the settings and the version that they are drawn from.
inline constexpr std::string_view png_mark_keyword = "Tumble-Scene";

/// Makes PNG files in memory, one after the other; not for several threads at once.
class PngEncoder {
public:
    /// `mark`: the text of a chunk png_mark_keyword in each file; none if it is empty.
    explicit PngEncoder(PngAlpha alpha = PngAlpha::dropped, std::string mark = {})
        : channels_(alpha == PngAlpha::kept ? 4 : 3), mark_(std::move(mark)) {}

    /// The whole file, valid until the next call. `changed`: the regions that may differ from the previous image; a
    /// first image, or one of another size, is converted completely. Throws RunError if the image is empty or
    /// memory runs out.
    std::span<const std::byte> encode(const Image& image, std::span<const Rectangle> changed);
    std::span<const std::byte> encode(const Image& image);

private:
    friend class PngRowWriter;
    struct Band {
        std::vector<std::uint8_t> compressed;
        std::uint32_t checksum = 0;  // Adler-32 of its rows
    };
    void compress(const Image& image, int first_row, Band& band);
    void make_head();

    int channels_;
    std::string mark_;
    Deflater deflater_;
    int width_ = 0, height_ = 0;  // of the previous image
    std::vector<Band> bands_;
    std::vector<std::uint8_t> rows_;  // of one band, filtered
    std::vector<std::byte> head_, file_;
};

/// Upper bound of the size of a PNG file, bytes.
std::size_t png_bytes_bound(int width, int height, PngAlpha alpha = PngAlpha::dropped);

/// Writes a PNG file without alpha of an image that arrives row by row, with only one band in memory.
class PngRowWriter {
public:
    /// Throws RunError naming the path.
    PngRowWriter(const std::filesystem::path& path, int width, int height);

    /// Four bytes per pixel; call it once per row.
    void add_row(std::span<const std::uint8_t> row);

    /// Renames the file to its final name.
    void finish();

private:
    void write_band();

    TemporaryFile file_;
    PngEncoder encoder_;
    Image band_;  // the current rows
    int height_;
    int rows_ = 0;                // number of rows received
    std::uint32_t checksum_ = 1;  // Adler-32 of the written rows
    PngEncoder::Band compressed_;
    std::vector<std::byte> chunk_;
};

/// Writes through a temporary file. Throws RunError naming the path.
void write_png(const std::filesystem::path& path, const Image& image, PngAlpha alpha = PngAlpha::dropped);

}  // namespace tumble
