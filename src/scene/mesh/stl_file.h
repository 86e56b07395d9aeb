// STL files: text with one or more solids, and binary.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <string_view>

namespace tumble {

/// The bytes are those of the file. Each solid of a text is an object. Normals are left out: they are those of the facets and
/// say nothing of smoothness. Throws MeshError.
MeshFile read_stl(std::string_view bytes);

}  // namespace tumble
