#include "app/files/frame_folder.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>

namespace tumble {

namespace fs = std::filesystem;

fs::path frame_path(const fs::path& folder, std::int64_t frame) {
    return folder / fmt::format("frame_{:06}.png", frame);
}

std::vector<std::int64_t> frames_in(const fs::path& folder) { return numbers_in(folder, "frame_", ".png"); }

/// A number of six digits or more.
std::optional<std::int64_t> number_in(std::string_view name, std::string_view before, std::string_view after) {
    if (!name.starts_with(before) || !name.ends_with(after) || name.size() < before.size() + after.size())
        return std::nullopt;
    const char* first = name.data() + before.size();
    const char* last = name.data() + name.size() - after.size();
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(first, last, number);
    if (error != std::errc() || end != last || last - first < 6 || number < 0) return std::nullopt;
    return number;
}

std::vector<std::int64_t> numbers_in(const fs::path& folder, std::string_view before, std::string_view after) {
    std::error_code error;
    std::vector<std::int64_t> numbers;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (const auto number = number_in(entry->path().filename().string(), before, after)) numbers.push_back(*number);
    if (error) throw InputError({folder.string(), 0, 0}, "cannot be read as a folder: " + error.message());
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

FrameFolder::FrameFolder(const fs::path& folder) : folder_(folder) {
    try {
        make();
        lock_.emplace(folder);
    } catch (...) {
        remove_empty();
        throw;
    }
    remove_left_parts(folder, [](std::string_view name) {
        return number_in(name, "frame_", ".png") || number_in(name, "aov_", ".npz");
    });
}

void FrameFolder::make() {
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path p = fs::absolute(folder_).lexically_normal(); fs::status(p, error).type() == fs::file_type::not_found;
         p = p.parent_path())
        missing.push_back(p);
    std::error_code failed;
    for (auto p = missing.rbegin(); p != missing.rend() && !failed; ++p)
        if (fs::create_directory(*p, failed)) made_.push_back(*p);
    if (!failed && !fs::is_directory(folder_, failed) && !failed)
        failed = std::make_error_code(std::errc::not_a_directory);
    if (failed) throw RunError(fmt::format("cannot make the folder '{}': {}", safe_path(folder_), failed.message()));
}

FrameFolder::~FrameFolder() {
    lock_.reset();
    remove_empty();
}

void FrameFolder::remove_empty() const {
    std::error_code not_empty;
    for (auto p = made_.rbegin(); p != made_.rend(); ++p) fs::remove(*p, not_empty);
}

}  // namespace tumble
