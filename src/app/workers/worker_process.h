// Parts that all worker processes share. They are forked from the program, draw in a single thread on one core, and
// exchange messages with it.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <cerrno>
#include <exception>
#include <string>

namespace tumble {

/// Makes this process, forked from `program`, a worker: it ends with the program, gets no Ctrl-C of a terminal, and has
/// no blocked signals; llvmpipe draws in its only thread. Call it before the first OpenGL call.
void become_worker(pid_t program);

/// The error text without the prefix "error: ", which the program adds.
std::string reason_of(const std::exception& error);

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

}  // namespace tumble
