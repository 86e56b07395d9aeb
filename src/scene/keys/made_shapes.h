// Shapes whose mesh is made from numbers: the hull of points, and a height field.
#pragma once

#include "scene/keys/shapes.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>

namespace tumble {

/// `{ type = "hull", points = [[x, y, z], ...] }`
ShapeRequest read_hull(const TomlTable& table);

/// `{ type = "heightfield", file, size = [x, z], height, base }`. The file is relative to `folder`; it is added to the
/// files of `meshes`.
ShapeRequest read_height_field(const TomlTable& table, const std::filesystem::path& folder, MeshCache& meshes);

}  // namespace tumble
