// The file that an output's name leads to.
#pragma once

#include <filesystem>
#include <optional>

namespace tumble {

struct OutputTarget {
    std::filesystem::path path;     // the name to replace or to make, after following links
    std::optional<int> descriptor;  // of this process, if the name stands for one: /dev/stdout, /dev/fd/N
    bool in_place = false;          // a descriptor, a device or a pipe: written to directly, never replaced
};

/// Throws InputError if links form a loop.
OutputTarget output_target(const std::filesystem::path& name);

inline bool is_written_in_place(const std::filesystem::path& name) { return output_target(name).in_place; }

}  // namespace tumble
