// Import of the mesh formats that Tumble does not read itself: 3MF by lib3mf, the others (Collada, 3D Studio, OFF, FBX
// and more) by assimp. It runs in a child process (import_process.h).
#pragma once

#include "scene/mesh/mesh_file.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace tumble {

/// True if assimp reads files of that ending (".dae", lower case).
bool assimp_reads(const std::string& extension);

/// Imports the bytes of a file; no other file is opened but its images, in `folder` or below. Throws MeshError if they
/// cannot be read, if the import crashes, or if it takes more memory or time than a mesh within limits.h needs.
MeshFile import_with_assimp(std::string_view bytes, const std::filesystem::path& folder, const std::string& extension);

}  // namespace tumble
