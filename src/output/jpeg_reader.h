// Reads JPEG files row by row.
#pragma once

#include "core/input_file.h"
#include "output/png_reader.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tumble {

/// An image from top to bottom, as it is stored (an orientation for viewers is not followed): 8-bit sRGB with alpha
/// 255. Memory: a few rows, or six bytes for each pixel of a progressive file.
class JpegRows {
public:
    /// Reads the header. Throws InputError naming the file (`name`) if it is no JPEG file, broken, too large or CMYK.
    JpegRows(OpenFile file, const std::string& name);
    ~JpegRows();
    JpegRows(const JpegRows&) = delete;
    JpegRows& operator=(const JpegRows&) = delete;

    ImageSize size() const;

    /// The next row, four bytes per pixel, valid until the next call. Precondition: rows are left. Throws InputError if
    /// the file is broken or cut short.
    std::span<const std::uint8_t> next();

private:
    struct File;  // state of libjpeg

    std::unique_ptr<File> file_;
    std::vector<std::uint8_t> row_;
    int next_ = 0;  // row
};

}  // namespace tumble
