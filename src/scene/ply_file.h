// PLY files (Turk 1994): text and binary, positions, normals and polygons; other elements and properties are passed
// over. Read by ourselves, because assimp 5.2 never returns from a text file that ends early (measured).
#pragma once

#include "scene/mesh_file.h"

namespace tumble {

/// The file exists. Throws MeshError.
MeshFile read_ply(const std::filesystem::path& file);

}  // namespace tumble
