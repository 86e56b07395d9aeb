#include "output/temporary_folder.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_lock.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view common_prefix = "tumble-";
constexpr std::size_t random_characters = 6;       // of mkdtemp()
constexpr const char* mark = ".tumble.temporary";  // the locked file that makes a folder ours

fs::path folder_of_temporary_files() {
    std::error_code error;
    fs::path folder = fs::temp_directory_path(error);
    if (error) throw RunError("cannot find the folder of temporary files (TMPDIR): " + error.message());
    return folder;
}

bool may_be_ours(const std::string& name, std::string_view prefix) {
    return name.size() > prefix.size() + random_characters - 1 && name.starts_with(prefix) &&
           std::all_of(name.end() - random_characters, name.end(),
                       [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; });
}

/// The lock of its mark, which is free if its process has ended; otherwise nothing.
OpenFile lock_if_left(const fs::path& folder) {
    struct stat status {};
    if (::lstat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != ::geteuid()) return {};
    const int file = ::open((folder / mark).c_str(), O_RDWR | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return {};
    if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && lock_file(file) == Lock::taken &&
        is_still_at(file, folder / mark))
        if (OpenFile left{::fdopen(file, "rb")}) return left;
    ::close(file);
    return {};
}

}  // namespace

std::vector<LeftFolder> left_folders(const fs::path& parent, std::string_view prefix) {
    std::error_code error;  // a folder that cannot be listed is ignored
    std::vector<LeftFolder> folders;
    for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error))
        if (may_be_ours(entry->path().filename().string(), prefix))
            if (OpenFile lock = lock_if_left(entry->path())) folders.push_back({entry->path(), std::move(lock)});
    return folders;
}

void remove_left_folders(const fs::path& parent, std::string_view prefix) {
    std::error_code ignored;
    for (const LeftFolder& folder : left_folders(parent, prefix)) fs::remove_all(folder.path, ignored);
}

TemporaryFolder::TemporaryFolder(const std::string& purpose) {
    const fs::path parent = folder_of_temporary_files();
    remove_left_folders(parent, common_prefix);
    while (!make(parent, fmt::format("{}{}-", common_prefix, purpose))) continue;
}

TemporaryFolder::TemporaryFolder(const fs::path& parent, const std::string& prefix) {
    while (!make(parent, prefix)) continue;
}

/// False: another run has taken it for one that was left, between the two calls.
bool TemporaryFolder::make(const fs::path& parent, const std::string& prefix) {
    std::string name = (parent / (prefix + "XXXXXX")).string();
    const auto fail = [&] {
        throw RunError(fmt::format("cannot make a temporary folder {}: {}", safe_path(name), std::strerror(errno)));
    };
    if (::mkdtemp(name.data()) == nullptr) fail();
    path_ = name;
    lock_ = ::open((path_ / mark).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (lock_ < 0) {
        const int error = errno;
        ::rmdir(path_.c_str());
        errno = error;
        fail();
    }
    if (lock_file(lock_) != Lock::held && is_still_at(lock_, path_ / mark)) return true;
    ::close(std::exchange(lock_, -1));
    return false;
}

void TemporaryFolder::remove() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);  // while it is locked
}

TemporaryFolder::~TemporaryFolder() {
    if (!kept_) remove();
    if (lock_ >= 0) ::close(lock_);
}

}  // namespace tumble
