// Reads any PNG file, whole or row by row.
#pragma once

#include "core/image.h"
#include "core/input_file.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// Largest number of pixels of a image: 16384 x 16384, 1 GiB in memory. A small hostile file may claim far more.
inline constexpr std::int64_t max_image_pixels = std::int64_t(1) << 28;

/// The numbers of a gray image, row by row from the top.
struct GrayImage {
    int width = 0, height = 0;
    std::vector<std::uint16_t> samples;
};

/// The samples of a gray PNG file as they are, without a gamma: fewer than 16 bits are stretched to 0 to 65535. Throws
/// InputError if it is missing, not a PNG file, broken, not gray, or has more than `most` pixels.
GrayImage read_gray_png(const std::filesystem::path& path, std::int64_t most);

/// A image from top to bottom. Every color type, depth and interlacing becomes 8-bit sRGB with alpha (255 if the file
/// has none). Memory: two rows, or the whole image for an interlaced file.
class PngRows {
public:
    /// Reads the header. Throws InputError naming the file if it is missing, not a PNG file, broken or too large.
    explicit PngRows(const std::filesystem::path& path);
    /// The same for an open file; `name` is for messages.
    PngRows(OpenFile file, const std::string& name);
    ~PngRows();
    PngRows(const PngRows&) = delete;
    PngRows& operator=(const PngRows&) = delete;

    ImageSize size() const;
    bool interlaced() const;

    /// The next row, four bytes per pixel, valid until the next call. Precondition: rows are left. Throws InputError if
    /// the file is broken or cut short, RunError if there is no memory for an interlaced image.
    std::span<const std::uint8_t> next();

    /// All rows; an alternative to next().
    Image all();

private:
    friend GrayImage read_gray_png(const std::filesystem::path& path, std::int64_t most);
    struct File;  // state of libpng
    void read_interlaced();

    std::unique_ptr<File> file_;
    Image whole_;                    // of an interlaced file
    std::vector<std::uint8_t> row_;  // of another file
    int next_ = 0;                   // row
};

/// Throws like PngRows.
Image read_png(const std::filesystem::path& path);

/// The size, from the header.
ImageSize read_png_size(const std::filesystem::path& path);

// -- The mark of a PNG file (png_mark_keyword), and the checksums of its chunks: pixels are not unpacked.

struct PngState {
    bool whole = false;               // all chunks are there with their checksums, and nothing behind them
    std::optional<std::string> mark;  // of a file whose head is intact
};

PngState state_of_png(const std::filesystem::path& path);

/// The mark alone, from the head of the file, which may be damaged behind it.
std::optional<std::string> mark_of_png(const std::filesystem::path& path);

}  // namespace tumble
