// Pictures of the difference of two images: the first one dimmed to gray, with differences in red (beyond the
// tolerance) and blue (within it, magnified). Images of two sizes both lie at the top left of a canvas that holds
// either: pixels of the first one alone are yellow, pixels of the second one alone green, and the rest of the canvas is
// black.
#pragma once

#include "compare/image_compare.h"
#include "core/image.h"
#include "output/picture_reader.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace tumble {

/// A row, as long as the longer of both.
void difference_row(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int tolerance,
                    std::span<std::uint8_t> to);

Image difference_image(const Image& a, const Image& b, const CompareOptions& options = {});

/// The size of the canvas.
ImageSize difference_size(ImageSize a, ImageSize b);

/// The same of picture files, with a few rows in memory. Throws InputError, RunError.
void write_difference_image(const std::filesystem::path& a, const std::filesystem::path& b,
                            const CompareOptions& options, const std::filesystem::path& file);

}  // namespace tumble
