// STL files: text with one or more solids, and binary.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <string_view>

namespace tumble {

/// `bytes`: content of the file. Each solid of a text is an object. Normals are ignored, because they are those of
/// facets and carry no information about smoothness. Throws MeshError.
MeshFile read_stl(std::string_view bytes);

}  // namespace tumble
