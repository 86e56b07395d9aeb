// A file on its way, under a hidden name beside its final one: ".clip.mp4.tumble.part-1b2c3d4e". It is locked while its
// process lives, so that a later run can tell what a killed one left behind, whatever process numbers say and wherever
// the other process runs.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace tumble {

class PartFile {
public:
    /// Creates it, empty. Throws RunError naming `final_path`.
    explicit PartFile(const std::filesystem::path& final_path);
    /// Removes it, unless it was moved.
    ~PartFile();
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    int descriptor() const { return file_; }

    /// Gives it its final name; what stands there is replaced. Throws RunError.
    void move_to_final_path();

private:
    [[noreturn]] void fail(int error) const;

    std::filesystem::path final_path_, path_;
    int file_ = -1;
    bool moved_ = false;
};

/// Removes what runs that are gone left of this final path. What another user owns, or what cannot be locked, stays.
void remove_left_parts(const std::filesystem::path& final_path);

/// The same of all final names in a folder that are among `ours` (those that a hidden name can hold whole).
void remove_left_parts(const std::filesystem::path& folder, const std::function<bool(std::string_view)>& ours);

}  // namespace tumble
