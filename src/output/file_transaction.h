// Several files of a folder that get their names together: all of them or none, also after the process is killed.
//
// The files are written into a hidden folder, and when all of them are on the disk, a journal of their names. Then they
// are renamed. Without a journal, none has been renamed; with one whose process has ended, the next run renames the
// rest.
#pragma once

#include "output/output_path.h"
#include "output/temporary_folder.h"

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace tumble {

/// Renames the files that the journals of killed runs list. Throws RunError if one cannot be renamed.
void finish_left_transactions(const std::filesystem::path& folder);

class FileTransaction {
public:
    explicit FileTransaction(const std::filesystem::path& folder, InnerLinks links = InnerLinks::followed)
        : folder_(folder), links_(links) {}

    /// Writes a file for a name in the folder (output_path.h); folders are made. Throws InputError, RunError. No
    /// existing file changes before commit().
    void add(const std::filesystem::path& name, std::string_view bytes);

    /// Throws RunError; the next run then renames the files that are left.
    void commit();

private:
    void begin();

    std::filesystem::path folder_;
    InnerLinks links_;
    std::optional<TemporaryFolder> staged_;     // made with the first file
    std::vector<std::filesystem::path> names_;  // below the folder, without links
};

}  // namespace tumble
