// Reads pictures, PNG or JPEG by their first bytes, whole or row by row.
#pragma once

#include "output/jpeg_reader.h"
#include "output/png_reader.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace tumble {

/// A picture from top to bottom, 8-bit sRGB with alpha. All members throw InputError naming the file, as PngRows and
/// JpegRows.
class PictureRows {
public:
    explicit PictureRows(const std::filesystem::path& file);

    ImageSize size() const { return jpeg_ ? jpeg_->size() : png_->size(); }
    /// Valid until the next call. Precondition: rows are left.
    std::span<const std::uint8_t> next() { return jpeg_ ? jpeg_->next() : png_->next(); }
    /// All rows; an alternative to next().
    Image all();

private:
    std::optional<PngRows> png_;
    std::optional<JpegRows> jpeg_;
};

Image read_picture(const std::filesystem::path& file);
ImageSize read_picture_size(const std::filesystem::path& file);

/// "image/jpeg" or "image/png", by the first bytes.
std::string_view picture_media_type(std::span<const std::byte> file);

}  // namespace tumble
