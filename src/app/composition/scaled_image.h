// An image at another size: the mean of the light that its pixels cover, weighted by their alpha.
#pragma once

#include "core/image.h"
#include "scene/description/mesh_paint.h"

namespace tumble {

/// sRGB with straight alpha, which is multiplied by the opacity. A larger image is interpolated.
Image scaled_image(const Texture::Level& image, int width, int height, double opacity);

}  // namespace tumble
