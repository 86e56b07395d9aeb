// Any PNG file as one of our pictures, whole or row by row.
#pragma once

#include "core/image.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tumble {

struct PictureSize {
    int width = 0, height = 0;   // pixels
    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// The most pixels a picture may have: 16384 x 16384, 1 GiB in memory. A small hostile file may claim far more.
inline constexpr std::int64_t max_picture_pixels = std::int64_t(1) << 28;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

/// A picture from top to bottom. Every color type, depth and interlacing becomes 8-bit sRGB with alpha (255 where the file
/// has none). Memory is needed for two rows; for the whole picture only where the file is interlaced.
class PngRows {
public:
    /// Reads the head. Throws InputError naming the file where it is missing, no PNG, broken or too large.
    explicit PngRows(const std::filesystem::path& path);
    /// The same of an open file; `name` is for messages.
    PngRows(OpenFile file, const std::string& name);
    ~PngRows();
    PngRows(const PngRows&) = delete;
    PngRows& operator=(const PngRows&) = delete;

    PictureSize size() const;
    bool interlaced() const;

    /// The next row, four bytes a pixel, valid until the next call; at most as often as there are rows. Throws InputError
    /// where the file is broken or cut short, RunError where there is no memory for an interlaced picture.
    std::span<const std::uint8_t> next();

    /// All rows, in place of next().
    Image all();

private:
    struct File;   // libpng's
    void read_interlaced();

    std::unique_ptr<File> file_;
    Image whole_;                     // of an interlaced file
    std::vector<std::uint8_t> row_;   // of another
    int next_ = 0;                    // row
};

/// Throws like PngRows.
Image read_png(const std::filesystem::path& path);

/// The size alone, from the file's head.
PictureSize read_png_size(const std::filesystem::path& path);

}  // namespace tumble
