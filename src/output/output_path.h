// Where outputs go: folders, the file that a name leads to, and names that stay below their folder (the references of a
// suite, the samples of a sweep, the pages of lessons).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tumble {

/// The file that an output's name leads to.
struct OutputTarget {
    std::filesystem::path path;     // the name to replace or to make, after following links
    std::optional<int> descriptor;  // of this process, if the name stands for one: /dev/stdout, /dev/fd/N
    bool in_place = false;          // a descriptor, a device or a pipe: written to directly, never replaced
};

/// Throws InputError if links form a loop.
OutputTarget output_target(const std::filesystem::path& name);

inline bool is_written_in_place(const std::filesystem::path& name) { return output_target(name).in_place; }

/// Makes the folder, and the folders above it, where they are missing. Throws RunError naming it.
void make_folder(const std::filesystem::path& folder);

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
