// Comparison of two PNG files row by row, so that images of any size take little memory.
#pragma once

#include "output/image_compare.h"

#include <filesystem>

namespace tumble {

/// Writes an image of the differences (see difference_row) where that file is named. Throws InputError where an image is
/// missing or broken or the sizes differ, RunError where the difference cannot be written.
Comparison compare_png_files(const std::filesystem::path& a, const std::filesystem::path& b,
                             const CompareOptions& options, const std::filesystem::path& difference_file);

}  // namespace tumble
