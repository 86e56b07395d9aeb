#include "app/workers/worker_process.h"

#include <malloc.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace tumble {
namespace {

constexpr int largest_kept_block = 4 << 20, kept_memory = 32 << 20;  // bytes

}  // namespace

void become_worker(pid_t program) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a worker that hangs or was stopped ends with the program as well
    if (::getppid() != program) ::_exit(0);
    ::setpgid(0, 0);  // Ctrl-C must reach it only through the program
    sigset_t none;
    sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    // Keeps freed memory for the next frame: returned to the system, it would come back as hundreds of new pages.
    // Larger blocks are returned.
    ::mallopt(M_MMAP_THRESHOLD, largest_kept_block);
    ::mallopt(M_TRIM_THRESHOLD, kept_memory);
    ::setenv("LP_NUM_THREADS", "0", 1);  // llvmpipe draws in this thread: one core per worker
}

std::string reason_of(const std::exception& error) {
    std::string_view text = error.what();
    constexpr std::string_view prefix = "error: ";
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
    return std::string(text);
}

}  // namespace tumble
