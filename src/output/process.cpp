#include "output/process.h"

#include "core/child_process.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

extern char** environ;

namespace tumble {
namespace {

namespace fs = std::filesystem;

// A program that stopped reading before its input ended has failed: time limit for its error message and its end.
constexpr std::chrono::seconds last_message_time{1};
constexpr std::size_t kept_error_bytes = 4096;  // bytes of a program's last output to standard error
constexpr std::size_t pipe_bytes = 1 << 20;     // the largest pipe that a user may request: fewer waits per frame
constexpr std::size_t kept_output = 1 << 16;    // bytes of a program's standard output
// ms between checks for the end of a program whose pipes are silent, because other processes may hold those open.
constexpr int poll_period = 20;

/// Starts the program with these descriptors as standard input, output and error (-1: nothing to read, or output is
/// dropped).
pid_t start(const fs::path& program, const std::vector<std::string>& arguments, int input, int output, int error) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    const auto give = [&](int from, int to, int how) {
        if (from >= 0)
            posix_spawn_file_actions_adddup2(&files, from, to);
        else
            posix_spawn_file_actions_addopen(&files, to, "/dev/null", how, 0);
    };
    give(input, STDIN_FILENO, O_RDONLY);
    give(output, STDOUT_FILENO, O_WRONLY);
    give(error, STDERR_FILENO, O_WRONLY);

    // It must not inherit blocked signals: its own group, an empty mask, default SIGPIPE.
    posix_spawnattr_t how;
    posix_spawnattr_init(&how);
    sigset_t none, defaults;
    sigemptyset(&none);
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE);
    posix_spawnattr_setsigmask(&how, &none);
    posix_spawnattr_setsigdefault(&how, &defaults);
    posix_spawnattr_setpgroup(&how, 0);
    posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);

    std::vector<std::string> command{program.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : command) argv.push_back(argument.data());
    argv.push_back(nullptr);

    pid_t id = -1;
    const int failed = posix_spawn(&id, program.c_str(), &files, &how, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&how);
    if (failed != 0)
        throw RunError(
            fmt::format("cannot start '{}': {}", safe_path(program), std::generic_category().message(failed)));
    return id;
}

/// During its lifetime, a write to a pipe without a reader gives EPIPE instead of a signal, in this thread only. The
/// signal is pending at the thread, and is removed before the old mask is restored.
class NoSigpipe {
public:
    NoSigpipe() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGPIPE);
        pthread_sigmask(SIG_BLOCK, &set_, &before_);
    }
    ~NoSigpipe() {
        if (sigismember(&before_, SIGPIPE) == 1) return;
        const timespec no_wait{0, 0};
        while (sigtimedwait(&set_, nullptr, &no_wait) < 0 && errno == EINTR) {
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoSigpipe(const NoSigpipe&) = delete;
    NoSigpipe& operator=(const NoSigpipe&) = delete;

private:
    sigset_t set_, before_;
};

/// Reads the available data of a pipe, without waiting. False: no writer is left, and all data was read.
bool read_waiting(int pipe, std::string& text) {
    pollfd polled{pipe, POLLIN, 0};
    if (::poll(&polled, 1, 0) <= 0) return true;
    int waiting = 0;
    if (::ioctl(pipe, FIONREAD, &waiting) != 0 || waiting == 0) return (polled.revents & POLLIN) != 0;
    std::array<char, 4096> part;
    while (waiting > 0) {
        const ssize_t n = ::read(pipe, part.data(), std::min(part.size(), static_cast<std::size_t>(waiting)));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        text.append(part.data(), static_cast<std::size_t>(n));
        waiting -= int(n);
    }
    return true;
}

/// Waits until the child has ended, without reaping it, so that its number stays reserved. True also if there is no
/// such child.
bool is_ended(pid_t id, int how) {
    siginfo_t info{};
    int result = 0;
    while ((result = ::waitid(P_PID, static_cast<id_t>(id), &info, WEXITED | WNOWAIT | how)) < 0 && errno == EINTR) {
    }
    return result < 0 || info.si_pid == id;
}

void kill_group(pid_t id) {
    if (::kill(-id, SIGKILL) != 0) ::kill(id, SIGKILL);
}

}  // namespace

bool has_ended(pid_t id) { return is_ended(id, WNOHANG); }

bool ends_within(pid_t id, std::chrono::milliseconds limit) {
    using std::chrono::microseconds;
    const auto end = std::chrono::steady_clock::now() + limit;
    for (microseconds nap(100); !has_ended(id);
         nap = std::min<microseconds>(2 * nap, std::chrono::milliseconds(poll_period))) {
        if (std::chrono::steady_clock::now() >= end) return false;
        std::this_thread::sleep_for(nap);
    }
    return true;
}

ProcessEnd wait_for_process(pid_t id) {
    int status = 0;
    rusage used{};
    while (::wait4(id, &status, 0, &used) < 0 && errno == EINTR) {
    }
    ProcessEnd end;
    if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    end.cpu_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
    end.peak_memory = std::int64_t(used.ru_maxrss) * 1024;
    return end;
}

std::optional<fs::path> find_program(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const fs::path candidate = fs::path(folder.empty() ? "." : folder) / name;
        std::error_code ignored;
        if (fs::is_regular_file(candidate, ignored) && ::access(candidate.c_str(), X_OK) == 0) return candidate;
    }
    return std::nullopt;
}

std::string ProcessEnd::describe() const {
    if (signal != 0) return fmt::format("ended by signal {} ({})", signal, strsignal(signal));
    return fmt::format("exit code {}", exit_code);
}

Process::Process(const fs::path& program, const std::vector<std::string>& arguments, std::optional<int> output) {
    Pipe input, errors;
    // Refused beyond the user's limit; the pipe then stays small.
    ::fcntl(input.write_end(), F_SETPIPE_SZ, int(pipe_bytes));
    // This end only, so that waiting for the program also notices its end.
    ::fcntl(input.write_end(), F_SETFL, O_NONBLOCK);
    id_ = start(program, arguments, input.read_end(), output.value_or(-1), errors.write_end());
    input_ = input.take_write();
    error_pipe_ = errors.take_read();
}

Process::~Process() {
    if (id_ < 0) return;
    kill();
    finish();
}

void Process::read_error_text() {
    if (error_pipe_ < 0) return;
    if (!read_waiting(error_pipe_, error_text_)) ::close(std::exchange(error_pipe_, -1));
    if (error_text_.size() > 2 * kept_error_bytes) error_text_.erase(0, error_text_.size() - kept_error_bytes);
}

bool Process::wait_for_room() {
    for (;;) {
        // A full pipe of messages would block the program.
        std::array<pollfd, 2> polled{{{input_, POLLOUT, 0}, {error_pipe_, POLLIN, 0}}};
        if (::poll(polled.data(), polled.size(), poll_period) < 0) continue;  // a signal: the result is invalid
        if (polled[1].revents != 0) read_error_text();
        if (polled[0].revents != 0) return true;
        if (has_ended(id_)) return false;  // a process that it started holds its input open
    }
}

bool Process::write(std::span<const std::byte> bytes) {
    const NoSigpipe guard;
    while (!bytes.empty()) {
        const ssize_t n = ::write(input_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno == EAGAIN && wait_for_room()) continue;
        if (n < 0) {
            reads_no_more_ = true;
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return true;
}

bool Process::lend(std::shared_ptr<const std::byte> memory, std::size_t size) {
    std::span<const std::byte> bytes(memory.get(), size);
    if (size < pipe_bytes) return write(bytes);
    {
        const NoSigpipe guard;
        while (!bytes.empty()) {
            const iovec rest{const_cast<std::byte*>(bytes.data()), bytes.size()};
            const ssize_t n = ::vmsplice(input_, &rest, 1, SPLICE_F_NONBLOCK);
            if (n < 0 && errno == EINTR) continue;
            if (n < 0 && errno == EAGAIN && wait_for_room()) continue;
            if (n < 0) break;
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }
    // The earlier memory has been read, because more than a pipe's capacity came after it.
    lent_ = std::move(memory);
    return write(bytes);  // the rest, if it cannot be lent
}

ProcessEnd Process::finish() {
    ::close(std::exchange(input_, -1));
    const auto deadline = std::chrono::steady_clock::now() + last_message_time;
    // Do not wait for its standard error to close, because a process that it started may hold that open.
    while ((error_pipe_ >= 0 || reads_no_more_) && !has_ended(id_)) {
        pollfd polled{error_pipe_, POLLIN, 0};  // without a pipe the poll only waits
        ::poll(&polled, 1, poll_period);
        read_error_text();
        if (reads_no_more_ && std::chrono::steady_clock::now() > deadline) kill();
    }
    is_ended(id_, 0);
    read_error_text();  // its last message is still in the pipe
    if (error_pipe_ >= 0) ::close(std::exchange(error_pipe_, -1));
    const std::lock_guard lock(id_mutex_);
    ProcessEnd end = wait_for_process(std::exchange(id_, -1));
    while (!error_text_.empty() && (error_text_.back() == '\n' || error_text_.back() == '\r')) error_text_.pop_back();
    end.error_text = std::move(error_text_);
    return end;
}

void Process::kill() {
    const std::lock_guard lock(id_mutex_);
    if (id_ >= 0) kill_group(id_);
}

ProgramOutput listen_to(pid_t id, int pipe, const std::function<bool()>& stop) {
    ProgramOutput output;
    bool open = true;
    while (!has_ended(id)) {
        pollfd polled{open ? pipe : -1, POLLIN, 0};
        ::poll(&polled, 1, poll_period);
        open = open && read_waiting(pipe, output.text);
        output.text.resize(std::min(output.text.size(), kept_output));
        if (!stop()) continue;
        output.stopped = true;
        kill_group(id);
        break;
    }
    output.end = wait_for_process(id);
    if (open) read_waiting(pipe, output.text);
    output.text.resize(std::min(output.text.size(), kept_output));
    return output;
}

ProgramOutput run_program(const fs::path& program, const std::vector<std::string>& arguments,
                          const std::function<bool()>& stop) {
    Pipe output;
    const pid_t id = start(program, arguments, -1, output.write_end(), -1);
    output.close_write();
    return listen_to(id, output.read_end(), stop);
}

std::optional<std::string> output_of(const fs::path& program, const std::vector<std::string>& arguments) {
    try {
        const ProgramOutput output = run_program(program, arguments, [] { return false; });
        if (output.end.ok()) return output.text;
    } catch (const RunError&) {
    }
    return std::nullopt;
}

}  // namespace tumble
