#include "app/threads/interrupt.h"

#include <initializer_list>

namespace tumble {

Interrupt::Interrupt() {
    sigemptyset(&watched_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) sigaddset(&watched_, signal);
    }
    pthread_sigmask(SIG_BLOCK, &watched_, &before_);
}

Interrupt::~Interrupt() {
    pending();  // a signal that came after the work must not end the program before it has reported the result
    restore();
}

bool Interrupt::pending() {
    if (restored_) return false;
    const timespec no_wait{0, 0};
    if (sigtimedwait(&watched_, nullptr, &no_wait) < 0) return false;
    restore();
    return true;
}

void Interrupt::restore() {
    if (!restored_) pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    restored_ = true;
}

}  // namespace tumble
