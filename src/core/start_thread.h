// Starts a thread, or reports the failure as an error.
#pragma once

#include "core/available_memory.h"
#include "core/error.h"

#include <system_error>
#include <utility>

namespace tumble {

/// A std::thread or std::jthread. Throws RunError if the system has no more threads or no memory for a stack.
template <class Thread, class Work>
Thread start_thread(Work&& work) {
    try {
        return Thread(std::forward<Work>(work));
    } catch (const std::system_error& error) {
        throw RunError("cannot start a thread: " + error.code().message() + memory_limit_note());
    }
}

}  // namespace tumble
