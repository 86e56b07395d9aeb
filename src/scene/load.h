// From a scene file to a checked description: parse, check, resolve.
#pragma once

#include "scene/description/description.h"
#include "scene/keys/overrides.h"
#include "scene/mesh/mesh_loader.h"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

using FileList = std::vector<std::filesystem::path>;

/// Throws InputError with file, line and column for any violation of the format. Appends the files that were read to
/// `read`, if given: the scene's own and those of its meshes.
SceneDescription load_scene(const std::filesystem::path& file, const SceneOverrides& overrides = {},
                            FileList* read = nullptr, MeshImports imports = MeshImports::in_child_process);

/// The text of a scene file. Throws InputError if it cannot be read, or is too large.
std::string read_scene_text(const std::filesystem::path& file);

/// The same from text; relative mesh paths are relative to the folder of `file`. With `supplied`, a shape may be
/// { type = "mesh", memory = INDEX, scale = ... }: the mesh in memory of that index.
SceneDescription parse_scene(const std::string& text, const std::filesystem::path& file,
                             const SceneOverrides& overrides = {}, FileList* read = nullptr,
                             MeshImports imports = MeshImports::in_child_process, MeshSupplier supplied = {});

}  // namespace tumble
