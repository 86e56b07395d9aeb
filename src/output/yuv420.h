// From images to video: planes of brightness (Y) and color differences (Cb, Cr), the latter for squares of 2 x 2 pixels
// (4:2:0), by ITU-R BT.709, limited range, 8 bits:
//
//   Y  = 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B) / 255
//   Cb = 128 + 224 (B - (Y - 16) 255 / 219) / 1.8556 / 255,   Cr the same with R and 1.5748
//
// of the encoded values R, G, B; Cb and Cr of the mean of the four pixels, so that they are sited at the center of the
// square. Computed in integers (15 fractional bits): the same bytes on every processor, within one level of the
// formula.
#pragma once

#include "core/image.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tumble {

/// Bytes of a frame: the Y plane, then Cb, then Cr, rows without padding. Precondition: width and height are even.
std::size_t yuv420_bytes(int width, int height);

/// Converts the region, enlarged to whole squares; the rest of the planes is unchanged. Precondition: the size is even.
void convert_to_yuv420(const Image& image, const Rectangle& region, std::span<std::uint8_t> planes);

// From images with straight alpha to video: the planes of yuv420.h, and alpha at full size and full range (0 to 255).
//
// A pixel without coverage gets the mean color of the covered ones in its block of 16 x 16 pixels: the color planes are
// coded with less detail than alpha, and a black surrounding would bleed into the rims of bodies.

/// Bytes of a frame: the planes of yuv420.h, then alpha. Precondition: width and height are even.
std::size_t yuva420_bytes(int width, int height);

/// Converts the region, enlarged to whole blocks; the rest of the planes is unchanged. `filled`: work space, any image.
/// Precondition: the size is even.
void convert_to_yuva420(const Image& image, const Rectangle& region, Image& filled, std::span<std::uint8_t> planes);

}  // namespace tumble
