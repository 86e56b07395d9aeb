#include "output/make_folder.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <system_error>

namespace tumble {

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!error && !std::filesystem::is_directory(folder, error) && !error)
        error = std::make_error_code(std::errc::not_a_directory);
    if (error) throw RunError(fmt::format("cannot make the folder '{}': {}", safe_path(folder), error.message()));
}

}  // namespace tumble
