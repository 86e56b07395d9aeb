// The bytes of a file that a scene names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tumble {

/// The whole of a regular file; links are followed. Throws MeshError if it is missing, of another kind (a folder, a
/// FIFO or a device, without waiting for it), unreadable, or larger than the limit in bytes.
std::string read_regular_file(const std::filesystem::path& file, std::int64_t limit);

}  // namespace tumble
