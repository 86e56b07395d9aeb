// From images with straight alpha to video: the planes of yuv420.h, and alpha at full size and full range (0 to 255).
//
// A pixel without coverage gets the mean color of the covered ones in its block of 16 x 16 pixels: the color planes are
// coded with less detail than alpha, and a black surrounding would bleed into the rims of bodies.
#pragma once

#include "core/image.h"
#include "core/rectangle.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

/// Bytes of a frame: the planes of yuv420.h, then alpha. Precondition: width and height are even.
std::size_t yuva420_bytes(int width, int height);

/// Converts the region, enlarged to whole blocks; the rest of the planes is unchanged. `filled`: work space, any image.
/// Precondition: the size is even.
void convert_to_yuva420(const Image& image, const Rectangle& region, Image& filled, std::span<std::uint8_t> planes);

}  // namespace tumble
