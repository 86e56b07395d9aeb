// The bytes of a mesh file, or of a file that it names.
#pragma once

#include <filesystem>
#include <string>

namespace tumble {

/// Throws MeshError if it cannot be read as a regular file (core/input_file.h), or is larger than the limit.
std::string read_mesh_bytes(const std::filesystem::path& file);

}  // namespace tumble
