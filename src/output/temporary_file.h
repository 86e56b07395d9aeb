// Outputs appear whole or not at all: they are written to a hidden name in the same folder (part_file.h), and renamed when
// all of it is on the disk.
#pragma once

#include "output/output_target.h"
#include "output/part_file.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

namespace tumble {

/// What earlier runs that were killed left of the same output.
enum class LeftParts {
    removed,
    kept,   // one of many files in a folder, which is looked through once for all
};

/// A file on its way. Unless it is published it is removed again, and what stood under the final name stays.
/// An output_target.h that is written in place is written in place; a pipe once a program reads it.
class TemporaryFile {
public:
    /// Creates the hidden file. Throws RunError naming `final_path` where its folder is missing or not writable.
    explicit TemporaryFile(const std::filesystem::path& final_path, LeftParts left = LeftParts::removed);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    /// The output is a pipe, a device or an open descriptor: its bytes go straight there.
    bool in_place() const { return !part_; }
    /// Where another program writes until commit(), unless it is given descriptor().
    const std::filesystem::path& path() const { return part_ ? part_->path() : target_.path; }
    /// The one that this process was given as the output, if it was.
    std::optional<int> descriptor() const { return target_.descriptor; }

    /// Appends all the bytes. Throws RunError naming the final path (disk full, ...).
    void write(std::span<const std::byte> bytes);

    /// Everything that follows write(): the file is brought to the disk and given its final name, for good.
    void commit();

    // The steps of commit(), for many files at a time; the folder of all of them is brought to the disk once
    // (bring_to_disk()). All throw RunError.
    void begin_sync();   // the disk begins to write; does not wait
    void sync();
    void publish();      // the final name

private:
    [[noreturn]] void fail(int error) const;

    OutputTarget target_;
    std::optional<PartFile> part_;   // unless it is written in place
    int file_ = -1;                  // the part's, or one of our own
};

/// The names in a folder, as far as the file system can.
void bring_to_disk(const std::filesystem::path& folder);

/// All of a file at once. Throws RunError naming the path.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace tumble
