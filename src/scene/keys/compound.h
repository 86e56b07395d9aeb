// shape = { type = "compound", parts = [...] }: several shapes that form one body; and meshes given as convex parts.
#pragma once

#include "scene/description/description.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>

namespace tumble {

/// Reads the parts of a body of that type. Nested compounds are flattened.
CompoundShape read_compound(const TomlTable& table, BodyType type, const std::filesystem::path& folder,
                            MeshCache& meshes);

}  // namespace tumble
