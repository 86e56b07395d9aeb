// Wavefront OBJ files: positions, normals, texture coordinates, colors, polygons, their objects and their materials.
// Curves are skipped.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <filesystem>
#include <string_view>

namespace tumble {

/// `bytes`: content of the file; the files of its materials and images are in `folder` or below, or are missing. Throws
/// MeshError.
MeshFile read_obj(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace tumble
