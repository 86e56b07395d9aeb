#include "output/file_lock.h"

#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>

namespace tumble {

Lock lock_file(int file, LockKind kind) {
    while (::flock(file, (kind == LockKind::alone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) return Lock::held;
        if (errno != EINTR) return Lock::unknown;
    }
    return Lock::taken;
}

bool is_still_at(int file, const std::filesystem::path& path) {
    struct stat open {
    }, named{};
    return ::fstat(file, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

}  // namespace tumble
