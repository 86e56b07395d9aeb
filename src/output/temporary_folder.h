// A folder of its own for files on their way elsewhere.
#pragma once

#include <filesystem>
#include <string>

namespace tumble {

/// It is removed with all its files at the end of the lifetime.
class TemporaryFolder {
public:
    /// In the folder of temporary files (TMPDIR), with the name "tumble-PURPOSE-" and six random characters. Throws
    /// RunError.
    explicit TemporaryFolder(const std::string& purpose);
    /// In a folder that exists, with a name of `prefix` and six random characters. Throws RunError.
    TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace tumble
