// Where two images differ at all. Metrics of a neighborhood need no work elsewhere.
#pragma once

#include "core/image.h"

namespace tumble {

/// The smallest rectangle with all pixels that differ in any channel; empty if the images are equal. Precondition: the
/// sizes are equal.
Rectangle changed_region(const Image& a, const Image& b);

/// The rectangle with `margin` more pixels at each side, within the image. An empty one stays empty.
Rectangle with_margin(const Rectangle& region, int margin, const Image& image);

}  // namespace tumble
