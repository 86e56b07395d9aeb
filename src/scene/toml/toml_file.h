// The text of a TOML file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tumble {

/// Throws InputError if the file, a "scene" or a "plan" for messages, cannot be read, or is larger than the limit.
std::string read_toml_file(const std::filesystem::path& file, const std::string& what, std::int64_t most_bytes);

}  // namespace tumble
