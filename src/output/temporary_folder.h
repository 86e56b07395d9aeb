// A folder of its own for files on their way elsewhere. It is locked while its process lives; a later run can therefore
// recognize and remove the folder of a killed one.
#pragma once

#include "core/input_file.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The temporary folder of an ended run, locked by this one.
struct LeftFolder {
    std::filesystem::path path;
    OpenFile lock;
};

/// The folders with this prefix. Folders of other users, and others that merely have such a name, are not among them.
std::vector<LeftFolder> left_folders(const std::filesystem::path& parent, std::string_view prefix);
void remove_left_folders(const std::filesystem::path& parent, std::string_view prefix);

/// It is removed with all its files at the end of the lifetime.
class TemporaryFolder {
public:
    /// In the folder of temporary files (TMPDIR), with the name "tumble-PURPOSE-" and six random characters. Removes
    /// those that killed runs left there, of any purpose. Throws RunError.
    explicit TemporaryFolder(const std::string& purpose);
    /// In a folder that exists, with a name of `prefix` and six random characters. Throws RunError.
    TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

    /// From here on it stays at the end of the lifetime, as that of a killed run does.
    void keep() { kept_ = true; }
    void remove();

private:
    bool make(const std::filesystem::path& parent, const std::string& prefix);

    std::filesystem::path path_;
    int lock_ = -1;  // its mark, open
    bool kept_ = false;
};

}  // namespace tumble
