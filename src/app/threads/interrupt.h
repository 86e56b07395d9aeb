// Ctrl-C and its relatives, taken in order between two pieces of work instead of in the middle of one.
#pragma once

#include <signal.h>

namespace tumble {

/// While it lives, SIGINT, SIGTERM and SIGHUP wait in this thread and in those it starts, until pending() takes one.
/// A signal that waits at its end is dropped: the work is over, and its result or error is still to be told.
/// A signal that was ignored before (nohup) stays ignored.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    /// True when one has come. From then on the next one ends the program at once.
    bool pending();

private:
    void restore();

    sigset_t watched_, before_;
    bool restored_ = false;
};

}  // namespace tumble
