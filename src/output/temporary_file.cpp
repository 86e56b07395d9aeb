#include "output/temporary_file.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

namespace tumble {
namespace {

namespace fs = std::filesystem;

// The app layer blocks Ctrl-C, so it interrupts no system call: check for it and handle it.
void stop_if_interrupted() {
    sigset_t waiting, taken;
    if (sigpending(&waiting) != 0) return;
    sigemptyset(&taken);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (sigismember(&waiting, signal) == 1) sigaddset(&taken, signal);
    const timespec no_wait{0, 0};
    if (!sigisemptyset(&taken) && sigtimedwait(&taken, nullptr, &no_wait) > 0) throw Interrupted();
}

constexpr int interrupt_poll_period = 20;  // ms between checks for an interrupt while waiting for a reader

/// Waits for a reader, like open(). The descriptor does not block.
int open_pipe(const fs::path& path) {
    for (;;) {
        const int file = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0 || (errno != ENXIO && errno != EINTR)) return file;
        stop_if_interrupted();
        std::this_thread::sleep_for(std::chrono::milliseconds(interrupt_poll_period));
    }
}

/// A pipe is opened again if possible, so that other holders of the descriptor are not affected by non-blocking mode.
int copy_of_descriptor(int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && S_ISFIFO(status.st_mode)) {
        const int file = ::open(fmt::format("/proc/self/fd/{}", descriptor).c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0) return file;
    }
    return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
}

void wait_until_read(int pipe) {
    pollfd place{pipe, POLLOUT, 0};
    if (::poll(&place, 1, interrupt_poll_period) <= 0) stop_if_interrupted();
}

}  // namespace

TemporaryFile::TemporaryFile(const fs::path& final_path, LeftParts left) : target_(output_target(final_path)) {
    std::error_code ignored;
    if (fs::is_directory(target_.path, ignored)) fail(EISDIR);
    if (target_.descriptor) {
        const int how = ::fcntl(*target_.descriptor, F_GETFL);
        if (how >= 0 && (how & O_ACCMODE) == O_RDONLY) fail(EBADF);
        file_ = copy_of_descriptor(*target_.descriptor);
    } else if (target_.in_place) {
        // The only regular file that is written in place is another process's descriptor: its content stays.
        file_ = fs::is_fifo(target_.path, ignored) ? open_pipe(target_.path)
                                                   : ::open(target_.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    } else {
        if (left == LeftParts::removed) remove_left_parts(target_.path);
        part_.emplace(target_.path);
        file_ = part_->descriptor();
    }
    if (file_ < 0) fail(errno);
}

TemporaryFile::~TemporaryFile() {
    if (!part_ && file_ >= 0) ::close(file_);
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EAGAIN) {
            wait_until_read(file_);
            continue;
        }
        if (n < 0) fail(errno);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

void TemporaryFile::begin_sync() {
    if (part_) ::sync_file_range(file_, 0, 0, SYNC_FILE_RANGE_WRITE);  // errors are reported by sync()
}

void TemporaryFile::sync() {
    // Some file systems cannot sync single files.
    while (part_ && ::fsync(file_) != 0)
        if (errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP)
            break;
        else if (errno != EINTR)
            fail(errno);
}

void TemporaryFile::publish() {
    if (part_) {
        part_->move_to_final_path();
    } else if (::close(std::exchange(file_, -1)) != 0 && errno != EINTR) {
        fail(errno);
    }
}

void TemporaryFile::commit() {
    sync();
    publish();
    if (part_) bring_to_disk(target_.path.parent_path());
}

void TemporaryFile::fail(int error) const {
    throw RunError(
        fmt::format("cannot write '{}': {}", safe_path(target_.path), std::generic_category().message(error)));
}

void bring_to_disk(const fs::path& folder) {
    const int file = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) return;  // a folder that is writable but not readable
    ::fsync(file);
    ::close(file);
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
    TemporaryFile file(path);
    file.write(bytes);
    file.commit();
}

void write_file(const fs::path& path, std::string_view text) { write_file(path, std::as_bytes(std::span(text))); }

}  // namespace tumble
