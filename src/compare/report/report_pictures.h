// The pictures of a report: of each pair both images, heat maps of their difference, and a thumbnail, as files in
// memory, within a number of bytes.
#pragma once

#include "compare/comparison.h"
#include "core/image.h"
#include "output/picture_reader.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tumble {

using PictureBytes = std::vector<std::byte>;  // of a PNG or a JPEG file

/// The whole error of a pair, of FLIP.
struct FlipFigures {
    double mean = 0.0, weighted_median = 0.0, quantile_99 = 0.0, maximum = 0.0;
};

struct PairPictures {
    PictureBytes reference, image;  // the files; empty: missing or unreadable
    ImageSize reference_size, image_size, difference_size;
    PictureBytes flip, windows;  // heat maps of a comparable pair
    PictureBytes difference;     // of a pair of two sizes (difference_image.h)
    PictureBytes thumbnail;      // of the image, otherwise of the reference
    float hottest_window = 0.0;  // levels that have the lightest color of `windows`
    std::optional<FlipFigures> figures;
    std::optional<double> ssim;
    bool left_out = false;  // for their size

    std::size_t bytes() const {
        return reference.size() + image.size() + flip.size() + windows.size() + difference.size() + thumbnail.size();
    }
};

/// The pictures of each result, in their order: of the first results up to the number of bytes; later ones keep
/// their thumbnails, where these are within it.
std::vector<PairPictures> report_pictures(const std::vector<const ImageResult*>& results, std::int64_t most_bytes,
                                          int workers);

// Small versions of pictures.

/// At most so many pixels on either side, with the proportions of the image; the image itself if it is as small. Each
/// pixel is the mean of the pixels of the image that it covers.
Image thumbnail(const Image& image, int width, int height);

}  // namespace tumble
