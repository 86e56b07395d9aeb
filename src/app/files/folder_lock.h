// Ensures that only one run at a time writes frames into a folder.
#pragma once

#include <filesystem>

namespace tumble {

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

}  // namespace tumble
