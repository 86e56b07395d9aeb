// Children: processes that are forked from the program and run a function of it, and pipes between both.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <functional>
#include <string_view>
#include <utility>

namespace tumble {

/// Both ends of a pipe, which programs that are started do not inherit. Its destructor closes an end that is still
/// open.
class Pipe {
public:
    /// Throws RunError.
    Pipe();
    ~Pipe();
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    int read_end() const { return read_; }
    int write_end() const { return write_; }
    void close_read();
    void close_write();
    /// The caller closes it.
    int take_read() { return std::exchange(read_, -1); }
    int take_write() { return std::exchange(write_, -1); }

private:
    int read_ = -1, write_ = -1;
};

/// Writes all bytes; false if no reader is left.
bool write_all(int file, std::string_view bytes);

struct ChildRules {
    int end_signal = SIGKILL;  // that the child gets when the program ends
    bool own_group = true;     // no Ctrl-C of a terminal, no blocked signals
};

/// Forks. The child ends with the program, calls `work` and exits with the code that it returns, without the
/// destructors of the program's objects. Preconditions: the program has no other thread, and `work` throws nothing.
/// Throws RunError if no process can be started.
pid_t fork_child(ChildRules rules, const std::function<int()>& work);

}  // namespace tumble
