// Outputs appear completely or not at all: they are written to a hidden name in the same folder (part_file.h), and
// renamed when all of it is on the disk.
#pragma once

#include "output/output_path.h"
#include "output/part_file.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace tumble {

/// Treatment of part files that killed runs left of the same output.
enum class LeftParts {
    removed,
    kept,  // for one of many files in a folder whose left-overs are removed once
};

/// An unfinished file. Unless it is published it is removed, and the existing file of the final name stays. A target
/// that is written in place (output_path.h) is opened directly; a pipe is opened when a program reads it.
class TemporaryFile {
public:
    /// Creates the hidden file. Throws RunError naming `final_path` if its folder is missing or not writable.
    explicit TemporaryFile(const std::filesystem::path& final_path, LeftParts left = LeftParts::removed);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    /// True if the output is a pipe, a device or an open descriptor, which is written to directly.
    bool in_place() const { return !part_; }
    /// The path that another program writes to until commit(), unless it is given descriptor().
    const std::filesystem::path& path() const { return part_ ? part_->path() : target_.path; }
    /// The descriptor of this process that was given as the output, if any.
    std::optional<int> descriptor() const { return target_.descriptor; }

    /// Appends all the bytes. Throws RunError naming the final path (disk full, ...).
    void write(std::span<const std::byte> bytes);
    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }

    /// Finishes the file after the last write(): it is synced to the disk and renamed to its final name.
    void commit();

    // The steps of commit(), for many files at a time; the folder of all of them is synced to the disk once
    // (bring_to_disk()). All throw RunError.
    void begin_sync();  // starts writing to the disk, without waiting
    void sync();
    void publish();  // renames to the final name

private:
    [[noreturn]] void fail(int error) const;

    OutputTarget target_;
    std::optional<PartFile> part_;  // empty if it is written in place
    int file_ = -1;                 // of the part file, or a descriptor of its own
};

/// Syncs the names in a folder, as far as the file system can.
void bring_to_disk(const std::filesystem::path& folder);

/// Writes all of a file at once. Throws RunError naming the path.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace tumble
