// Mean of images in linear light: sRGB values are decoded, summed, divided, and encoded. A pixel that is the same in
// all of them is unchanged, to the bit. Colors are weighted by their alpha, and alpha is averaged as it is.
#pragma once

#include "core/image.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Largest number of transparent images in a mean: their sums have 32 bits.
inline constexpr std::size_t most_images_with_alpha = 256;

class ImageMean {
public:
    /// `transparent`: with alpha; otherwise alpha is ignored, and the mean is opaque.
    explicit ImageMean(bool transparent = false);

    /// Adds an image of the size of the others.
    void add(const Image& image);
    /// The mean of all images since the last call (at least one).
    void take(Image& mean);

private:
    void make_tables();

    std::array<std::uint16_t, 256> linear_{};  // linear value of each sRGB value; 65535 is white
    std::vector<std::uint8_t> srgb_;           // nearest sRGB value of each linear value; empty until the first image
    bool transparent_;
    std::vector<std::uint32_t> sums_;  // R, G, B of each pixel; with alpha, R, G, B times alpha, and alpha
    int width_ = 0, height_ = 0;
    std::uint32_t count_ = 0;
};

}  // namespace tumble
