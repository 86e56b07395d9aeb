// Ctrl-C and similar signals, handled between two pieces of work instead of at any instruction.
#pragma once

#include <signal.h>

namespace tumble {

/// During its lifetime, SIGINT, SIGTERM and SIGHUP are blocked in this thread and in those it starts, until pending()
/// takes one. A signal that is pending at its end is dropped, because the work is over and its result or error has to
/// be reported. A signal that was ignored at construction (nohup) stays ignored.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    /// True if a signal has come. After that, another one ends the program at once.
    bool pending();

private:
    void restore();

    sigset_t watched_, before_;
    bool restored_ = false;
};

}  // namespace tumble
