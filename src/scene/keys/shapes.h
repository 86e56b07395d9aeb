// shape = { type = "box", ... }: planes, boxes, spheres, meshes and compounds of them.
#pragma once

#include "scene/description/description.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>
#include <optional>

namespace tumble {

/// A shape as given by the file, from which scaled copies can be made.
struct ShapeRequest {
    Shape shape;      // at scale 1
    MeshSource mesh;  // of a mesh
    double mesh_scale = 1.0;
    bool made = false;  // the mesh comes from no file: a hull or a height field
};

/// Reads and checks the shape of a body of that type. Relative mesh paths are relative to `folder`.
ShapeRequest read_shape(const TomlValue& value, BodyType type, const std::filesystem::path& folder, MeshCache& meshes);

/// The shape without the colors of its files.
Shape without_paint(const Shape& shape);
/// The mean color of the first mesh that has the colors of its file.
std::optional<Color> mean_paint(const Shape& shape);

/// The shape enlarged by a factor. Meshes of equal scale are shared.
Shape scaled(const ShapeRequest& request, double factor, MeshCache& meshes);

/// `{ type = "hull", points = [[x, y, z], ...] }`
ShapeRequest read_hull(const TomlTable& table);

/// `{ type = "heightfield", file, size = [x, z], height, base }`. The file is relative to `folder`; it is added to the
/// files of `meshes`.
ShapeRequest read_height_field(const TomlTable& table, const std::filesystem::path& folder, MeshCache& meshes);

}  // namespace tumble
