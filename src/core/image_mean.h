// Mean of images in linear light: sRGB values are decoded, summed, divided, and encoded. A pixel that is the same in
// all of them is unchanged, to the bit.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

class ImageMean {
public:
    ImageMean();

    /// Adds an image of the size of the others.
    void add(const Image& image);
    /// The mean of all images since the last call (at least one), opaque.
    void take(Image& mean);

private:
    std::array<std::uint16_t, 256> linear_;  // linear value of each sRGB value; 65535 is white
    std::vector<std::uint8_t> srgb_;         // nearest sRGB value of each linear value
    std::vector<std::uint32_t> sums_;        // R, G, B of each pixel
    int width_ = 0, height_ = 0;
    std::uint32_t count_ = 0;
};

}  // namespace tumble
