// The comparison of a pair of images by its tolerances.
#pragma once

#include "compare/comparison.h"
#include "compare/tolerances.h"
#include "core/image.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

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

// -- The comparison of many pairs at a time.

/// The next pair, or nothing at the end. Called by one thread at a time.
using PairSource = std::function<std::optional<ImagePair>()>;

/// Called with each result by the thread that found it: in no order, and several at a time.
using PairSink = std::function<void(const ImagePair&, ImageResult&)>;

/// Compares the pairs with `workers` threads; the results are in the order of the pairs. As many pairs are in memory as
/// there are workers. Throws the first error of the source, of a comparison or of the sink.
std::vector<ImageResult> compare_pairs(const PairSource& next, const Tolerances& tolerances, int workers,
                                       const PairSink& found = {});

}  // namespace tumble
