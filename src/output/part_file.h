// An unfinished file under a hidden name beside its final one: ".clip.mp4.tumble.part-1b2c3d4e". It is locked while its
// process lives. A later run can therefore recognize the file of a killed one, independent of process numbers and of
// the machine that the other process runs on.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace tumble {

class PartFile {
public:
    /// Creates an empty file. Throws RunError naming `final_path`.
    explicit PartFile(const std::filesystem::path& final_path);
    /// Removes the file, unless it was moved.
    ~PartFile();
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    int descriptor() const { return file_; }

    /// Renames it to its final name, replacing an existing file. Throws RunError.
    void move_to_final_path();

private:
    [[noreturn]] void fail(int error) const;

    std::filesystem::path final_path_, path_;
    int file_ = -1;
    bool moved_ = false;
};

/// Removes the part files of this final path whose runs have ended. Files of other users, or that cannot be locked,
/// stay.
void remove_left_parts(const std::filesystem::path& final_path);

/// The same for all final names in a folder for which `ours` is true (names short enough to be complete in the hidden
/// name).
void remove_left_parts(const std::filesystem::path& folder, const std::function<bool(std::string_view)>& ours);

}  // namespace tumble
