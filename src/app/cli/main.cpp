#include "app/cli/command_line.h"
#include "app/cli/say.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>

namespace {

/// Opens /dev/null for standard input, output and error if they are closed (">&-"). Otherwise the next file, pipe or
/// socket would get that number and receive, for example, the messages for standard error. Call it before anything is
/// opened.
///
/// Standard output is opened for reading, so that a write to it is still an error.
void open_missing_standard_streams() {
    constexpr std::array<int, 3> how{O_RDONLY, O_RDONLY, O_WRONLY};  // by descriptor
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
        // The lowest free descriptor is this one. Without /dev/null, a folder occupies it.
        if (::open("/dev/null", how[static_cast<std::size_t>(stream)]) < 0) ::open("/", O_RDONLY | O_DIRECTORY);
    }
}

/// Tells it, and returns the exit code.
int fail(const std::exception& error) {
    tumble::messages().fail(error);
    const int code = tumble::is_input_error(error) ? 2 : 1;
    tumble::messages().end(code);
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    open_missing_standard_streams();
    // A file beyond the user's size limit, and a pipe without a reader, then give an error of the write, like a full
    // disk.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    try {
        const int code = tumble::run_command_line(argc, argv);
        tumble::finish_standard_output();
        tumble::messages().end(code);
        return code;
    } catch (const std::exception& error) {
        return fail(error);
    }
}
