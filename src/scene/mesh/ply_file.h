// PLY files (Turk 1994): text and binary, positions, normals and polygons; other elements and properties are skipped.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <filesystem>
#include <string_view>

namespace tumble {

/// `bytes`: content of the file. Throws MeshError.
MeshFile read_ply(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace tumble
