// OBJ, STL and glTF files through assimp.
#pragma once

#include "scene/mesh_file.h"

namespace tumble {

/// All meshes of the file with their nodes' transforms. The file exists and is of a kind that assimp knows.
MeshFile read_with_assimp(const std::filesystem::path& file, bool with_normals);

}  // namespace tumble
