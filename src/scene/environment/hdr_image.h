// Images in Radiance's format (.hdr): red, green and blue with a common exponent.
#pragma once

#include "scene/description/environment.h"

#include <string_view>

namespace tumble {

/// True for the first bytes of such a file.
bool is_hdr_image(std::string_view bytes);

/// Reads rows from the top, each from the left, plain or run-length encoded. Throws MeshError if the file is broken,
/// in another order or color space, or larger than limits::environment_side.
EnvironmentImage read_hdr_image(std::string_view bytes);

}  // namespace tumble
