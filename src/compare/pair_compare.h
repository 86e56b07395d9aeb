// The comparison of a pair of images by its tolerances.
#pragma once

#include "compare/comparison.h"
#include "compare/tolerances.h"
#include "core/image.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

/// A PNG file, or an image in memory.
struct ComparedPicture {
    std::filesystem::path file;           // empty: in memory only
    std::shared_ptr<const Image> pixels;  // null: in the file only
};

struct ImagePair {
    std::string name;
    std::optional<ComparedPicture> reference, image;  // one of them at least
};

/// Every failure to read or to compare them makes the result `broken`, with the reason. Throws RunError if memory runs
/// out. Two PNG files take a few rows of memory, but whole images where a perceptual metric is asked for.
ImageResult compare_pair(const ImagePair& pair, const PairTolerances& tolerances);

}  // namespace tumble
