// A folder of frames: frame_000000.png, frame_000001.png, ...
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace tumble {

/// The file of frame n. Six digits, more if needed.
std::filesystem::path frame_path(const std::filesystem::path& folder, std::int64_t frame);

/// The frame numbers of the files in the folder, ascending. Throws InputError if it is no folder.
std::vector<std::int64_t> frames_in(const std::filesystem::path& folder);

/// The same for any files whose name is `before`, a number of six digits or more, and `after`.
std::vector<std::int64_t> numbers_in(const std::filesystem::path& folder, std::string_view before,
                                     std::string_view after);

/// The number in such a name; empty for another name.
std::optional<std::int64_t> number_in(std::string_view name, std::string_view before, std::string_view after);

/// Holds a folder during its lifetime, by a lock on a hidden file in it. The lock ends with the process, even if it is
/// killed; a file that a killed process left is taken over.
class FolderLock {
public:
    /// Throws RunError if another run holds the folder, or if no file can be made in it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    std::filesystem::path path_;
    int file_ = -1;
};

/// A folder for the frames of this run only. It is made if missing, and removed again if no file was ever written into
/// it.
class FrameFolder {
public:
    /// Removes unfinished frames and AOVs of killed runs. Throws RunError if the folder cannot be made or written into,
    /// or if another run writes into it.
    explicit FrameFolder(const std::filesystem::path& folder);
    ~FrameFolder();
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }

private:
    void make();
    void remove_empty() const;

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> made_;  // outermost first
    std::optional<FolderLock> lock_;
};

}  // namespace tumble
