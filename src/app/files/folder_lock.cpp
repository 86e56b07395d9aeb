#include "app/files/folder_lock.h"

#include "core/error.h"
#include "core/safe_text.h"
#include "output/file_lock.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace tumble {
namespace {

int open_lock(const std::filesystem::path& path) {
    constexpr int how = O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    const int file = ::open(path.c_str(), O_RDWR | how, 0666);
    return file < 0 && errno == EACCES ? ::open(path.c_str(), O_RDONLY | how, 0666) : file;  // a file of another user
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : path_(folder / ".tumble.lock") {
    for (;;) {
        file_ = open_lock(path_);
        if (file_ < 0)
            throw RunError(
                fmt::format("cannot write into '{}': {}", safe_path(folder), std::generic_category().message(errno)));
        const Lock lock = lock_file(file_);
        // The run that held it may have ended between the two calls and removed the file.
        if (lock != Lock::held && is_still_at(file_, path_)) return;
        ::close(file_);
        if (lock == Lock::held)
            throw RunError(
                fmt::format("cannot write into '{}': another run is writing frames there; wait for its end, or "
                            "name another folder",
                            safe_path(folder)));
    }
}

FolderLock::~FolderLock() {
    ::unlink(path_.c_str());  // while it is still locked
    ::close(file_);
}

}  // namespace tumble
