#include "app/compare/compare_input.h"

#include "core/error.h"

#include <algorithm>
#include <string_view>
#include <system_error>

namespace tumble {
namespace {

constexpr std::string_view clip_endings[] = {".mp4", ".mov", ".mkv", ".webm", ".gif", ".avi", ".m4v"};

}  // namespace

CompareInput compare_input(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(status)) return CompareInput::folder;
    if (!std::filesystem::exists(status)) throw InputError({path.string(), 0, 0}, "there is no such file or folder");
    const std::string ending = path.extension().string();
    if (ending == ".toml") return CompareInput::scene;
    const bool clip = std::find(std::begin(clip_endings), std::end(clip_endings), ending) != std::end(clip_endings);
    return clip ? CompareInput::clip : CompareInput::picture;
}

}  // namespace tumble
