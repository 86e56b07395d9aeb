// A folder for outputs.
#pragma once

#include <filesystem>

namespace tumble {

/// Makes it, and the folders above it, where they are missing. Throws RunError naming it.
void make_folder(const std::filesystem::path& folder);

}  // namespace tumble
