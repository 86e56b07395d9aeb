// Reader of 3MF files, by lib3mf. Call it in a child process (assimp_import.h): a malformed file can crash the library.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <string_view>

namespace tumble {

/// All objects that the file builds, with their transforms, in m with y up, in their colors. Without textures. Throws
/// MeshError if the file cannot be read.
MeshFile read_three_mf(std::string_view bytes);

}  // namespace tumble
