// Small versions of pictures.
#pragma once

#include "core/image.h"

namespace tumble {

/// At most so many pixels on either side, with the proportions of the image; the image itself if it is as small. Each
/// pixel is the mean of those that it covers.
Image thumbnail(const Image& image, int width, int height);

}  // namespace tumble
