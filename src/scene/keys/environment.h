// [environment].
#pragma once

#include "scene/description/description.h"
#include "scene/mesh/mesh_file.h"
#include "scene/toml/toml_reader.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace tumble {

/// `folder`: of the scene. Adds the image file to `files`.
std::optional<EnvironmentDescription> read_environment(const TomlTable& root, const std::filesystem::path& folder,
                                                       std::vector<std::filesystem::path>& files, MeshImports imports);

}  // namespace tumble
