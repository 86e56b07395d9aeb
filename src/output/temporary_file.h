// Outputs appear whole or not at all: they are written to a hidden name in the same folder, and renamed when done.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace tumble {

/// Is it there already and no regular file (a device, a named pipe)?
bool is_written_in_place(const std::filesystem::path& path);

/// A file on its way. Unless commit() is reached it is removed again, and what stood under the final name stays.
/// A final name that is_written_in_place() is written in place; a pipe once someone reads it.
class TemporaryFile {
public:
    /// Creates the hidden file, which keeps the ending of `final_path` (programs choose formats by it).
    /// Throws RunError naming `final_path` where its folder is missing or not writable.
    explicit TemporaryFile(const std::filesystem::path& final_path);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    /// Where to write until commit().
    const std::filesystem::path& path() const { return path_; }

    /// Appends all the bytes. Throws RunError naming the final path (disk full, ...).
    void write(std::span<const std::byte> bytes);

    /// Closes the file and gives it its final name. Throws RunError.
    void commit();

private:
    void close_file();

    std::filesystem::path final_path_;
    std::filesystem::path path_;
    int file_ = -1;
    bool in_place_ = false;
    bool done_ = false;
};

/// All of a file at once. Throws RunError naming the path.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace tumble
