#include "output/process.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>

extern char** environ;

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_words = 4096;      // bytes of a program's last words
constexpr std::size_t pipe_bytes = 1 << 20;           // the largest pipe a user may ask for: fewer waits for each frame

/// Two ends of a pipe, closed unless taken.
struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0)
            throw RunError("cannot make a pipe: " + std::generic_category().message(errno));
        read = ends[0];
        write = ends[1];
    }
    ~Pipe() {
        if (read >= 0) ::close(read);
        if (write >= 0) ::close(write);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    int take_read() { return std::exchange(read, -1); }
    int take_write() { return std::exchange(write, -1); }
};

/// Starts the program with these as its standard input, output and error (-1: nothing to read, nowhere to write).
pid_t start(const fs::path& program, const std::vector<std::string>& arguments, int input, int output, int error) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    const auto give = [&](int from, int to, int how) {
        if (from >= 0) posix_spawn_file_actions_adddup2(&files, from, to);
        else posix_spawn_file_actions_addopen(&files, to, "/dev/null", how, 0);
    };
    give(input, STDIN_FILENO, O_RDONLY);
    give(output, STDOUT_FILENO, O_WRONLY);
    give(error, STDERR_FILENO, O_WRONLY);

    // It must not inherit the signals we block: its own group, an empty mask, default SIGPIPE.
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

    std::vector<std::string> words{program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    pid_t id = -1;
    const int failed = posix_spawn(&id, program.c_str(), &files, &how, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&how);
    if (failed != 0)
        throw RunError(fmt::format("cannot start '{}': {}", safe_path(program), std::generic_category().message(failed)));
    return id;
}

/// While it lives, a write to a pipe without a reader is an error value (EPIPE) and no signal, in this thread only.
/// The signal then waits at the thread, and is taken away before the old mask comes back.
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
        while (sigtimedwait(&set_, nullptr, &no_wait) < 0 && errno == EINTR) {}
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    NoSigpipe(const NoSigpipe&) = delete;
    NoSigpipe& operator=(const NoSigpipe&) = delete;

private:
    sigset_t set_, before_;
};

}  // namespace

ProcessEnd wait_for_process(pid_t id) {
    int status = 0;
    rusage used{};
    while (::wait4(id, &status, 0, &used) < 0 && errno == EINTR) {}
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

Process::Process(const fs::path& program, const std::vector<std::string>& arguments) {
    Pipe input, words;
    ::fcntl(input.write, F_SETPIPE_SZ, int(pipe_bytes));   // refused at the user's limit: then it stays small
    id_ = start(program, arguments, input.read, -1, words.write);
    input_ = input.take_write();
    words_pipe_ = words.take_read();
    words_reader_ = std::thread([this] { keep_words(); });
}

Process::~Process() {
    if (id_ < 0) return;
    kill();
    finish();
}

void Process::keep_words() {
    std::array<char, 1024> part;
    for (;;) {
        const ssize_t n = ::read(words_pipe_, part.data(), part.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return;
        words_.append(part.data(), static_cast<std::size_t>(n));
        if (words_.size() > 2 * kept_words) words_.erase(0, words_.size() - kept_words);
    }
}

bool Process::write(std::span<const std::byte> bytes) {
    const NoSigpipe guard;
    while (!bytes.empty()) {
        const ssize_t n = ::write(input_, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
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
            const ssize_t n = ::vmsplice(input_, &rest, 1, 0);
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) break;
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }
    // What was lent before has been read: more than the pipe holds came after it.
    lent_ = std::move(memory);
    return write(bytes);   // the rest, where it cannot be lent
}

ProcessEnd Process::finish() {
    ::close(std::exchange(input_, -1));
    words_reader_.join();   // ends when the program closes its standard error, which it does by ending
    ::close(std::exchange(words_pipe_, -1));
    const std::lock_guard lock(id_mutex_);
    ProcessEnd end = wait_for_process(std::exchange(id_, -1));
    while (!words_.empty() && (words_.back() == '\n' || words_.back() == '\r')) words_.pop_back();
    end.words = std::move(words_);
    return end;
}

void Process::kill() {
    const std::lock_guard lock(id_mutex_);
    if (id_ >= 0) ::kill(id_, SIGKILL);
}

std::optional<std::string> output_of(const fs::path& program, const std::vector<std::string>& arguments) {
    Pipe output;
    pid_t id = -1;
    try {
        id = start(program, arguments, -1, output.write, -1);
    } catch (const RunError&) {
        return std::nullopt;
    }
    ::close(output.take_write());
    std::string text;
    std::array<char, 4096> part;
    for (ssize_t n; (n = ::read(output.read, part.data(), part.size())) != 0;) {
        if (n < 0 && errno != EINTR) break;
        if (n > 0 && text.size() < (1 << 16)) text.append(part.data(), static_cast<std::size_t>(n));
    }
    if (!wait_for_process(id).ok()) return std::nullopt;
    return text;
}

}  // namespace tumble
