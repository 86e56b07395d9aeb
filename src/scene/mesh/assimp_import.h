// Mesh files of formats without a reader in Tumble (.dae, .3ds, .off, .fbx, ...), imported by assimp. Its importers
// allocate as much as a file claims and can crash on a malformed one, so they run in a child process with limits of
// memory and time.
#pragma once

#include "scene/mesh/mesh_file.h"

#include <string>
#include <string_view>

namespace tumble {

/// True if assimp reads files of that ending (".dae", lower case).
bool assimp_reads(const std::string& extension);

/// Imports the bytes of a file; no other file is opened. Throws MeshError if they cannot be read, if the import
/// crashes, or if it takes more memory or time than a mesh within limits.h needs.
MeshFile import_with_assimp(std::string_view bytes, const std::string& extension);

}  // namespace tumble
