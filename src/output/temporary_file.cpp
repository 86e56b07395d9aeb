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

namespace tumble {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
    throw RunError(fmt::format("cannot write '{}': {}", safe_path(path), std::generic_category().message(error)));
}

/// A link is written through: the name it points to is the one to replace, or to make.
fs::path resolved(const fs::path& path) {
    constexpr int most_links = 40;   // Linux's own limit
    std::error_code error;
    if (fs::exists(path, error)) {
        if (!fs::is_symlink(path, error)) return path;
        const fs::path target = fs::canonical(path, error);
        return error ? path : target;
    }
    fs::path name = path;
    for (int i = 0; i < most_links && fs::is_symlink(name, error); ++i) name = name.parent_path() / fs::read_symlink(name, error);
    return name;
}

// The app layer lets Ctrl-C wait, so that it ends none of the system's calls: it is looked for, and taken.
void stop_if_interrupted() {
    sigset_t waiting, taken;
    if (sigpending(&waiting) != 0) return;
    sigemptyset(&taken);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
        if (sigismember(&waiting, signal) == 1) sigaddset(&taken, signal);
    const timespec no_wait{0, 0};
    if (!sigisemptyset(&taken) && sigtimedwait(&taken, nullptr, &no_wait) > 0) throw RunError("interrupted");
}

constexpr int look_every = 20;   // ms, for an interrupt while a reader keeps us waiting

/// Waits for a reader, as open() itself would. What is opened does not block.
int open_pipe(const fs::path& path) {
    for (;;) {
        const int file = ::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        if (file >= 0 || (errno != ENXIO && errno != EINTR)) return file;
        stop_if_interrupted();
        std::this_thread::sleep_for(std::chrono::milliseconds(look_every));
    }
}

void wait_until_read(int pipe) {
    pollfd place{pipe, POLLOUT, 0};
    if (::poll(&place, 1, look_every) <= 0) stop_if_interrupted();
}

}  // namespace

bool is_written_in_place(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::is_character_file(status) || fs::is_fifo(status) || fs::is_socket(status) || fs::is_block_file(status);
}

TemporaryFile::TemporaryFile(const fs::path& final_path) : final_path_(resolved(final_path)) {
    std::error_code ignored;
    if (fs::is_directory(final_path_, ignored)) fail(final_path_, EISDIR);
    in_place_ = is_written_in_place(final_path_);
    // The process number keeps two runs that write to one name apart.
    path_ = in_place_ ? final_path_
                      : final_path_.parent_path() / fmt::format(".{}.part-{}{}", final_path_.stem().string(), getpid(),
                                                                final_path_.extension().string());
    const int how = in_place_ ? O_WRONLY : O_WRONLY | O_CREAT | O_TRUNC;
    file_ = fs::is_fifo(path_, ignored) ? open_pipe(path_) : ::open(path_.c_str(), how | O_CLOEXEC, 0666);
    if (file_ < 0) fail(final_path_, errno);
}

TemporaryFile::~TemporaryFile() {
    if (file_ >= 0) ::close(file_);
    if (!done_ && !in_place_) ::unlink(path_.c_str());
}

void TemporaryFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EAGAIN) {
            wait_until_read(file_);
            continue;
        }
        if (n < 0) fail(final_path_, errno);
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
}

void TemporaryFile::close_file() {
    const int file = file_;
    file_ = -1;
    // Network file systems report a full disk only here.
    if (::close(file) != 0 && errno != EINTR) fail(final_path_, errno);
}

void TemporaryFile::commit() {
    close_file();
    if (!in_place_ && ::rename(path_.c_str(), final_path_.c_str()) != 0) fail(final_path_, errno);
    done_ = true;
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
    TemporaryFile file(path);
    file.write(bytes);
    file.commit();
}

}  // namespace tumble
