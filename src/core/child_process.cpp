#include "core/child_process.h"

#include "core/error.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace tumble {
namespace {

[[noreturn]] void fail(const char* problem) {
    throw RunError(std::string(problem) + ": " + std::generic_category().message(errno));
}

}  // namespace

Pipe::Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("cannot make a pipe");
    read_ = ends[0];
    write_ = ends[1];
}

Pipe::~Pipe() {
    close_read();
    close_write();
}

void Pipe::close_read() {
    if (read_ >= 0) ::close(take_read());
}

void Pipe::close_write() {
    if (write_ >= 0) ::close(take_write());
}

bool write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes.remove_prefix(std::size_t(n));
    }
    return true;
}

pid_t fork_child(ChildRules rules, const std::function<int()>& work) {
    std::fflush(nullptr);  // otherwise the child writes it once more
    const pid_t program = ::getpid(), id = ::fork();
    if (id < 0) fail("cannot start a process");
    if (id > 0) return id;
    ::prctl(PR_SET_PDEATHSIG, rules.end_signal);
    if (::getppid() != program) ::_exit(1);  // it has ended in between
    if (rules.own_group) {
        ::setpgid(0, 0);
        sigset_t none;
        sigemptyset(&none);
        ::sigprocmask(SIG_SETMASK, &none, nullptr);
    }
    ::_exit(work());
}

}  // namespace tumble
