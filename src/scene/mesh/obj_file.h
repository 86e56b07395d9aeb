// Wavefront OBJ files: positions, normals, polygons and their objects. Materials, texture coordinates and curves are
// skipped, and no other file is opened.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <string_view>

namespace tumble {

/// `bytes`: content of the file. Throws MeshError.
MeshFile read_obj(std::string_view bytes);

}  // namespace tumble
