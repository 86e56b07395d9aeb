#include "output/temporary_folder.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace tumble {

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) throw RunError("cannot find the folder of temporary files (TMPDIR): " + error.message());
    std::string name = (folder / fmt::format("tumble-{}-XXXXXX", purpose)).string();
    if (::mkdtemp(name.data()) == nullptr)
        throw RunError(fmt::format("cannot make a temporary folder {}: {}", safe_path(name), std::strerror(errno)));
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace tumble
