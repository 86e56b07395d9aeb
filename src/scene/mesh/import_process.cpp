#include "scene/mesh/import_process.h"

#include "core/child_process.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "scene/mesh/mesh_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

namespace tumble {
namespace {

// The first byte from the child: a result, or the text of an error.
constexpr char is_result = 'm', is_error = 'e';

constexpr std::size_t longest_error = 240;  // of an error

void write_to(int pipe, const void* data, std::size_t size) {
    if (!write_all(pipe, {static_cast<const char*>(data), size})) ::_exit(1);
}

int run_limited(const ImportLimits& limits, const std::function<void(ImportOutput&)>& work, int pipe) {
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit memory{};
    if (::getrlimit(RLIMIT_AS, &memory) == 0) {
        memory.rlim_cur =
            std::min(memory.rlim_max, pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + rlim_t(limits.memory));
        ::setrlimit(RLIMIT_AS, &memory);
    }
    std::signal(SIGALRM, SIG_DFL);
    ::alarm(limits.seconds);
    ImportOutput output(pipe);
    try {
        work(output);
    } catch (const std::bad_alloc&) {
        return ENOMEM;
    } catch (const std::exception& error) {
        if (!output.empty()) return 1;
        write_to(pipe, &is_error, 1);
        write_to(pipe, error.what(), std::strlen(error.what()));
    }
    return 0;
}

/// The child's end of the pipe closes when the child ends, even if it crashes.
std::string read_pipe(int file) {
    std::string all;
    char part[1 << 16];
    for (ssize_t n; (n = ::read(file, part, sizeof part)) != 0;) {
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) break;
        all.append(part, static_cast<std::size_t>(n));
    }
    return all;
}

[[noreturn]] void fail_import(int status, const ImportLimits& limits) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == ENOMEM)
        throw MeshError(fmt::format("takes more than {} MiB of memory to import", limits.memory >> 20));
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        throw MeshError(fmt::format("takes more than {} s to import", limits.seconds));
    if (WIFSIGNALED(status))
        throw MeshError(
            fmt::format("cannot be read, because {} crashes on it (signal {}); the file may be right: save it as {}",
                        limits.library, WTERMSIG(status), limits.instead));
    throw MeshError(fmt::format("cannot be imported by {}", limits.library));
}

}  // namespace

void ImportOutput::write(const void* data, std::size_t size) {
    if (empty_) write_to(pipe_, &is_result, 1);
    empty_ = false;
    write_to(pipe_, data, size);
}

std::string run_import(const ImportLimits& limits, const std::function<void(ImportOutput&)>& work) {
    std::string answer;
    pid_t child = -1;
    try {
        Pipe pipe;
        child = fork_child({.own_group = false}, [&] { return run_limited(limits, work, pipe.write_end()); });
        pipe.close_write();
        answer = read_pipe(pipe.read_end());
    } catch (const RunError& error) {
        throw MeshError("cannot be imported: " + error.message());
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty()) fail_import(status, limits);
    const bool failed = answer[0] == is_error;
    answer.erase(0, 1);
    if (failed) throw MeshError(readable(answer, longest_error));
    return answer;
}

}  // namespace tumble
