#include "output/temporary_folder.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace tumble {
namespace {

std::filesystem::path folder_of_temporary_files() {
    std::error_code error;
    std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) throw RunError("cannot find the folder of temporary files (TMPDIR): " + error.message());
    return folder;
}

}  // namespace

TemporaryFolder::TemporaryFolder(const std::string& purpose)
    : TemporaryFolder(folder_of_temporary_files(), fmt::format("tumble-{}-", purpose)) {}

TemporaryFolder::TemporaryFolder(const std::filesystem::path& parent, const std::string& prefix) {
    std::string name = (parent / (prefix + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr)
        throw RunError(fmt::format("cannot make a temporary folder {}: {}", safe_path(name), std::strerror(errno)));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace tumble
