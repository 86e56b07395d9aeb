// Images in the format of OpenEXR (.exr): light as half or whole floats.
#pragma once

#include "scene/description/environment.h"

#include <string_view>

namespace tumble {

/// True for the first bytes of such a file.
bool is_exr_image(std::string_view bytes);

/// Reads red, green and blue of the first part, by the library OpenEXR. Throws MeshError if the file is broken, has no
/// such channels, or is larger than limits::environment_side, or if this build has no OpenEXR. Negative
/// and invalid light is none.
EnvironmentImage read_exr_image(std::string_view bytes);

/// The same in a child process with limits of memory and time.
EnvironmentImage import_exr_image(std::string_view bytes);

}  // namespace tumble
