// A folder of its own for files on their way elsewhere.
#pragma once

#include <filesystem>
#include <string>

namespace tumble {

/// Made in the folder of temporary files (TMPDIR), and removed with all its files at the end of the lifetime.
class TemporaryFolder {
public:
    /// Its name is "tumble-PURPOSE-" and six random characters. Throws RunError.
    explicit TemporaryFolder(const std::string& purpose);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace tumble
