// The bytes of a mesh file, or of a file that it names.
#pragma once

#include <filesystem>
#include <string>

namespace tumble {

/// Throws MeshError if it cannot be read as a regular file (core/input_file.h), or is larger than the limit.
std::string read_mesh_bytes(const std::filesystem::path& file);

/// The file of that name after following links; it must be in the folder (after following links) or below. Throws
/// MeshError.
std::filesystem::path file_below(const std::filesystem::path& folder, const std::string& name);

}  // namespace tumble
