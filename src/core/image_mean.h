// The mean of pictures as light adds up: sRGB values to linear, summed, divided, and back. What is the same in all of them
// comes out as it was, to the bit.
#pragma once

#include "core/image.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

class ImageMean {
public:
    ImageMean();

    /// One more picture, of the size of the others.
    void add(const Image& image);
    /// The mean of all since the last call (at least one), opaque.
    void take(Image& mean);

private:
    std::array<std::uint16_t, 256> linear_;   // of each sRGB value, 65535 is white
    std::vector<std::uint8_t> srgb_;          // the nearest sRGB value of each linear one
    std::vector<std::uint32_t> sums_;         // R, G, B of each pixel
    int width_ = 0, height_ = 0;
    std::uint32_t count_ = 0;
};

}  // namespace tumble
