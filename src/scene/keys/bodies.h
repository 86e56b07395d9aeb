// [[body]]: the bodies of the scene, with grids and scatters expanded.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/materials.h"
#include "scene/mesh/mesh_loader.h"
#include "scene/toml/toml_reader.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace tumble {

/// Reads all body tables in file order. Relative mesh paths are relative to `folder`.
std::vector<BodyDescription> read_bodies(const TomlTable& root, const Materials& materials,
                                         const std::filesystem::path& folder, const SimulationSettings& settings,
                                         MeshCache& meshes);

}  // namespace tumble
