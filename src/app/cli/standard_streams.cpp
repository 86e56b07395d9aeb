#include "app/cli/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace tumble {

void open_missing_standard_streams() {
    constexpr std::array<int, 3> how{O_RDONLY, O_RDONLY, O_WRONLY};  // by descriptor
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
        if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
        // The lowest free descriptor is this one. Without /dev/null, a folder occupies it.
        if (::open("/dev/null", how[static_cast<std::size_t>(stream)]) < 0) ::open("/", O_RDONLY | O_DIRECTORY);
    }
}

}  // namespace tumble
