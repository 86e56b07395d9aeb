// A worker: a process that is forked from the program, works on one core in a single thread, which may have OpenGL
// contexts, and exchanges messages with the program. It can be stopped at any time.
#pragma once

#include "output/process.h"

#include <sys/socket.h>
#include <sys/types.h>

#include <cerrno>
#include <functional>
#include <mutex>
#include <span>

namespace tumble {

/// Messages arrive completely or not at all (SOCK_SEQPACKET). False: the other end is closed.
template <typename T>
bool send_message(int socket, const T& message) {
    ssize_t n = 0;
    while ((n = ::send(socket, &message, sizeof message, MSG_NOSIGNAL)) < 0 && errno == EINTR) {
    }
    return n == ssize_t(sizeof message);
}

template <typename T>
bool receive_message(int socket, T& message) {
    ssize_t n = 0;
    while ((n = ::recv(socket, &message, sizeof message, 0)) < 0 && errno == EINTR) {
    }
    return n == ssize_t(sizeof message);
}

class WorkerProcess {
public:
    /// Forks. The child ends with the program, gets no Ctrl-C of a terminal, and has no blocked signals; it closes the
    /// sockets of the workers that were started before it, calls `work` with its end of the socket, and exits with the
    /// code that `work` returns. Preconditions: the program has no other thread and no OpenGL context, and `work`
    /// throws nothing. Throws RunError, naming the purpose ("drawing"), if there are no more processes or no memory.
    WorkerProcess(const char* purpose, std::span<const int> other_sockets, const std::function<int(int socket)>& work);
    /// Ends the process in any state.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    pid_t id() const { return id_; }
    /// The program's end.
    int socket() const { return socket_; }
    /// False after finish().
    bool alive() const { return id_ >= 0; }

    /// Ends the process at once, from any thread.
    void kill();

    /// Ends the process and returns its usage. One that does not end within a second is killed.
    ProcessEnd finish();

private:
    pid_t id_ = -1;
    std::mutex
        id_mutex_;  // guards kill() against the end of finish(), after which another process may have that number
    int socket_ = -1;
};

}  // namespace tumble
