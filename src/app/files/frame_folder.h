// A folder of frames: frame_000000.png, frame_000001.png, ...
#pragma once

#include "output/file_lock.h"
#include "output/temporary_file.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
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

/// Holds a folder during its lifetime, by a lock on a hidden file in it: alone, or together with other runs that share
/// it. The lock ends with the process, even if it is killed; a file that a killed process left is taken over.
class FolderLock {
public:
    /// Throws RunError if another run holds the folder and one of the two wants it alone, or if no file can be made in
    /// it.
    FolderLock(const std::filesystem::path& folder, LockKind kind);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    std::filesystem::path path_;
    int file_ = -1;
};

/// A folder for the frames of this run, or of several that share it: each frame is written aside and renamed, so that
/// two writers of the same frame are harmless. The folder is made if missing, and removed again if no file was ever
/// written into it.
class FrameFolder {
public:
    /// Removes unfinished frames and AOVs of killed runs. Throws RunError if the folder cannot be made or written into,
    /// or if another run writes into it and the two do not share it.
    explicit FrameFolder(const std::filesystem::path& folder, LockKind kind = LockKind::alone);
    ~FrameFolder();
    FrameFolder(const FrameFolder&) = delete;
    FrameFolder& operator=(const FrameFolder&) = delete;

    const std::filesystem::path& path() const { return folder_; }

    /// Describes the frames: the file is there before the first frame has its name.
    void set_manifest(const std::filesystem::path& path, std::string text);
    /// Writes it, if there is one to write, and if the file does not have that text. Throws RunError.
    void write_manifest();

    /// Writes the file of one frame, without publishing it. Throws RunError naming the file.
    std::unique_ptr<TemporaryFile> write(std::int64_t frame, std::span<const std::byte> file);

private:
    void make();
    void remove_empty() const;

    std::filesystem::path manifest_path_;
    std::string manifest_;  // empty once it is written

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> made_;  // outermost first
    std::optional<FolderLock> lock_;
};

}  // namespace tumble
