#include "app/files/frame_folder.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_bytes.h"
#include "output/part_file.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace tumble {

namespace fs = std::filesystem;

namespace {

// A run that ends holds the lock alone for a moment, to remove the file.
constexpr int waits_for_end_of_run = 50;
constexpr auto wait_for_end_of_run = std::chrono::milliseconds(20);

int open_lock(const std::filesystem::path& path) {
    constexpr int how = O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    const int file = ::open(path.c_str(), O_RDWR | how, 0666);
    return file < 0 && errno == EACCES ? ::open(path.c_str(), O_RDONLY | how, 0666) : file;  // a file of another user
}

}  // namespace

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

FolderLock::FolderLock(const std::filesystem::path& folder, LockKind kind) : path_(folder / ".tumble.lock") {
    for (int waits = 0;;) {
        file_ = open_lock(path_);
        if (file_ < 0)
            throw RunError(
                fmt::format("cannot write into '{}': {}", safe_path(folder), std::generic_category().message(errno)));
        const Lock lock = lock_file(file_, kind);
        // The run that held it may have ended between the two calls and removed the file.
        if (lock != Lock::held && is_still_at(file_, path_)) return;
        ::close(file_);
        if (lock != Lock::held) continue;
        if (kind == LockKind::alone || ++waits > waits_for_end_of_run)
            throw RunError(
                fmt::format("cannot write into '{}': another run is writing frames there; wait for its end, or "
                            "name another folder",
                            safe_path(folder)));
        std::this_thread::sleep_for(wait_for_end_of_run);
    }
}

FolderLock::~FolderLock() {
    // While it is still locked. Others that share it keep the file: they hold it by its name.
    if (lock_file(file_) != Lock::held) ::unlink(path_.c_str());
    ::close(file_);
}

FrameFolder::FrameFolder(const fs::path& folder, LockKind kind) : folder_(folder) {
    try {
        make();
        lock_.emplace(folder, kind);
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

void FrameFolder::set_manifest(const fs::path& path, std::string text) {
    manifest_path_ = path;
    manifest_ = std::move(text);
}

void FrameFolder::write_manifest() {
    const std::string text = std::exchange(manifest_, {});
    if (!text.empty() && bytes_of_file(manifest_path_) != text) write_file(manifest_path_, text);
}

std::unique_ptr<TemporaryFile> FrameFolder::write(std::int64_t frame, std::span<const std::byte> file) {
    auto part = std::make_unique<TemporaryFile>(frame_path(folder_, frame), LeftParts::kept);
    part->write(file);
    write_manifest();  // after that: a full disk leaves an empty folder
    return part;
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
