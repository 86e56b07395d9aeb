// The kinds of operands of `tumble compare`.
#pragma once

#include <filesystem>

namespace tumble {

enum class CompareInput { picture, folder, clip, scene };

/// By its name, and by the file system for a folder. Throws InputError if a file or folder does not exist.
CompareInput compare_input(const std::filesystem::path& path);

}  // namespace tumble
