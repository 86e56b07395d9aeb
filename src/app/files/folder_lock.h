// One run at a time writes frames into a folder.
#pragma once

#include <filesystem>

namespace tumble {

/// Holds a folder while it lives, by a lock on a hidden file in it; the lock ends with the process, however that ends, and
/// a file that a killed process left is taken over.
class FolderLock {
public:
    /// Throws RunError where another run holds the folder, or no file can be made in it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    std::filesystem::path path_;
    int file_ = -1;
};

}  // namespace tumble
