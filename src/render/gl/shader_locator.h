// The folder of the shader files.
#pragma once

#include <filesystem>

namespace tumble {

/// $TUMBLE_SHADERS, else beside the installed program or shared library, else the source tree it was built from.
/// Throws RunError naming the folders that were searched.
std::filesystem::path find_shader_folder();

}  // namespace tumble
