#include "app/workers/worker_process.h"

#include "core/child_process.h"
#include "core/error.h"

#include <fmt/format.h>

#include <malloc.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

constexpr int largest_kept_block = 4 << 20, kept_memory = 32 << 20;  // bytes
constexpr auto longest_end = std::chrono::seconds(1);  // of a worker without a job, which takes milliseconds

/// Call it before the first OpenGL call.
void become_worker() {
    // Keeps freed memory for the next frame: returned to the system, it would come back as hundreds of new pages.
    // Larger blocks are returned.
    ::mallopt(M_MMAP_THRESHOLD, largest_kept_block);
    ::mallopt(M_TRIM_THRESHOLD, kept_memory);
    ::setenv("LP_NUM_THREADS", "0", 1);  // llvmpipe draws in this thread: one core per worker
}

}  // namespace

WorkerProcess::WorkerProcess(const char* purpose, std::span<const int> other_sockets,
                             const std::function<int(int socket)>& work) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        throw RunError("cannot make a socket: " + std::generic_category().message(errno));
    try {
        id_ = fork_child({}, [&] {
            become_worker();
            // A copy of the program's end of a socket in this process would keep the other worker from noticing the
            // program's end.
            ::close(ends[0]);
            for (const int socket : other_sockets) ::close(socket);
            return work(ends[1]);
        });
    } catch (const RunError& error) {
        for (const int end : ends) ::close(end);
        throw RunError(fmt::format("{} for {}", error.message(), purpose));
    }
    ::close(ends[1]);
    socket_ = ends[0];
}

WorkerProcess::~WorkerProcess() {
    kill();
    finish();
}

void WorkerProcess::kill() {
    const std::lock_guard lock(id_mutex_);
    if (id_ >= 0) ::kill(id_, SIGKILL);
}

ProcessEnd WorkerProcess::finish() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));  // the worker takes the closed socket as the end of its jobs
    if (id_ < 0) return {};
    if (!ends_within(id_, longest_end)) kill();
    const std::lock_guard lock(id_mutex_);
    return wait_for_process(std::exchange(id_, -1));
}

}  // namespace tumble
