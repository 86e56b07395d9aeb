// Outputs that stay below their folder, for any links that it holds: the references of a suite, the samples of a sweep,
// the pages of lessons.
#pragma once

#include <filesystem>
#include <string>

namespace tumble {

/// Links below the folder.
enum class InnerLinks {
    followed,  // to a place that is below the folder too
    refused,
};

/// FOLDER/NAME. Throws InputError if the name has a "..", if a link leads out of the folder (or there is a link at all,
/// where these are refused), or if the name is a folder, a pipe or a device. The folder itself may be a link, and
/// missing.
std::filesystem::path confined_path(const std::filesystem::path& folder, const std::filesystem::path& name,
                                    InnerLinks links = InnerLinks::followed);

}  // namespace tumble
