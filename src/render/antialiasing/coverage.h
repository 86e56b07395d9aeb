// Images with alpha. Only bodies are drawn, on black; the alpha of a pixel is the part of it that they cover. The edges
// of color and coverage are blended alike, so that the color is premultiplied (scaled by the coverage) until the end.
#pragma once

#include "core/image.h"
#include "core/rectangle.h"

#include <vector>

namespace tumble {

/// Copies the rectangles of the drawn image to the frame. `ids`: its alpha is a surface id (surface_ids.h), which becomes
/// the coverage of the pixel's center; else it is the coverage.
void copy_coverage(const Image& drawn, const std::vector<Rectangle>& rectangles, bool ids, Image& frame);

/// Divides the colors in the rectangles of the frame by their coverage.
void make_alpha_straight(const std::vector<Rectangle>& rectangles, Image& frame);

}  // namespace tumble
