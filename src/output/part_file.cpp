#include "output/part_file.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_lock.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <random>
#include <string>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_mark = ".tumble.part-";
constexpr std::size_t digits = 8;  // of the hexadecimal number behind it

fs::path folder_beside(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// The part of a final name that fits into a hidden one: all of it, except for the longest names.
std::string kept_of(std::string name) {
    const std::size_t room = NAME_MAX - 1 - part_mark.size() - digits;
    if (name.size() <= room) return name;
    std::size_t end = room;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // UTF-8 characters stay complete
    name.resize(end);
    return name;
}

/// The part of the final name in a hidden name, if that is the name of a part file.
std::optional<std::string_view> final_name_in(std::string_view name) {
    if (name.size() <= 1 + part_mark.size() + digits || name.front() != '.') return std::nullopt;
    const std::string_view number = name.substr(name.size() - digits);
    if (number.find_first_not_of("0123456789abcdef") != std::string_view::npos) return std::nullopt;
    const std::string_view rest = name.substr(1, name.size() - 1 - digits);
    if (!rest.ends_with(part_mark)) return std::nullopt;
    return rest.substr(0, rest.size() - part_mark.size());
}

/// Removes a part file if its process has ended: its lock is then free.
void remove_if_left(const fs::path& part) {
    const int file = ::open(part.c_str(), O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return;
    struct stat status {};
    if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && lock_file(file) == Lock::taken &&
        is_still_at(file, part))
        ::unlink(part.c_str());
    ::close(file);
}

}  // namespace

PartFile::PartFile(const fs::path& final_path) : final_path_(final_path) {
    std::random_device random;
    const std::string kept = kept_of(final_path.filename().string());
    for (;;) {
        path_ = final_path.parent_path() / fmt::format(".{}{}{:08x}", kept, part_mark, random() & 0xffffffffu);
        file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file_ < 0 && (errno == EEXIST || errno == EINTR)) continue;
        if (file_ < 0) fail(errno);
        // Between the two calls another run may have removed it as a left-over.
        if (lock_file(file_) != Lock::held && is_still_at(file_, path_)) return;
        ::close(file_);
    }
}

PartFile::~PartFile() {
    if (!moved_) ::unlink(path_.c_str());  // while it is locked
    if (file_ >= 0) ::close(file_);
}

void PartFile::move_to_final_path() {
    // Network file systems report a full disk when a descriptor is closed; the lock stays with the other copy.
    const int copy = ::fcntl(file_, F_DUPFD_CLOEXEC, 0);
    if (copy < 0) fail(errno);
    if (::close(copy) != 0 && errno != EINTR) fail(errno);
    if (::rename(path_.c_str(), final_path_.c_str()) != 0) fail(errno);
    moved_ = true;
}

void PartFile::fail(int error) const {
    throw RunError(
        fmt::format("cannot write '{}': {}", safe_path(final_path_), std::generic_category().message(error)));
}

void remove_left_parts(const fs::path& final_path) {
    const std::string kept = kept_of(final_path.filename().string());
    remove_left_parts(folder_beside(final_path), [&](std::string_view name) { return name == kept; });
}

void remove_left_parts(const fs::path& folder, const std::function<bool(std::string_view)>& ours) {
    std::error_code error;  // a folder that cannot be listed is ignored
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (const auto final_name = final_name_in(name); final_name && ours(*final_name)) remove_if_left(entry->path());
    }
}

}  // namespace tumble
