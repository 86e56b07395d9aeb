// The bytes of a small file, such as a frame.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

/// All bytes of a regular file, or the first `most`; empty if it is missing, not a regular file (a pipe would wait) or
/// cannot be read.
std::optional<std::string> bytes_of_file(const std::filesystem::path& path, std::size_t most = std::size_t(-1));

}  // namespace tumble
