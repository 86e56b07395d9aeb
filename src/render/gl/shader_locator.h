// The folder of the shader files.
#pragma once

#include <filesystem>

namespace tumble {

/// $TUMBLE_SHADERS if set; else a folder beside the installed program or shared library; else the source tree of the
/// build. Throws RunError that names the searched folders.
std::filesystem::path find_shader_folder();

}  // namespace tumble
